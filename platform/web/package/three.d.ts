// Types of noh-character/three.
import type { Camera, Group, Material, Mesh, WebGLRenderer } from 'three';
import type { Character, CharacterOptions, PackSource } from './index.js';

/** A character as an object of three.js: deformed by noh on the renderer's context, drawn by three's materials. */
export class NohObject3D extends Group {
    constructor(renderer: WebGLRenderer, options?: Pick<CharacterOptions, 'program' | 'path' | 'characters' | 'alive' | 'level' | 'speed' | 'paused' | 'calm'>);
    readonly isNohObject3D: true;
    /** Clips, targets, gaze, speech, memory. */
    readonly character: Character;
    /** One for each mesh of the pack; each has all of `materials`. */
    readonly meshes: Mesh[];
    /** Those of the pack, as MeshStandardMaterial or MeshBasicMaterial: change them, or put others of yours into the meshes. */
    readonly materials: Material[];
    /** Resolves when the pack is there as a whole. */
    load(source: PackSource): Promise<this>;
    /** Before each renderer.render: move time on by seconds, and deform what the camera is to see. */
    update(seconds: number, camera: Camera): void;
    /** Its GL objects and memory go; the context stays. */
    dispose(): void;
}
