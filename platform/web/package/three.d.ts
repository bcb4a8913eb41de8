// Types of noh-character/three.
import type { Camera, Group, Material, Mesh, WebGLRenderer } from 'three';
import type { Character, CharacterOptions, PackSource } from './index.js';

/** A character as an object of three.js: deformed by noh on the renderer's context, drawn by three's materials. */
export class NohObject3D extends Group {
    constructor(renderer: WebGLRenderer, options?: Pick<CharacterOptions, 'program' | 'path' | 'characters' | 'alive' | 'level' | 'speed' | 'paused' | 'calm'>);
    readonly isNohObject3D: true;
    /** Clips, targets, gaze, speech, memory. */
    readonly character: Character;
    /** One per mesh of the pack; each has all of `materials`. */
    readonly meshes: Mesh[];
    /** The pack's materials, as MeshStandardMaterial or MeshBasicMaterial: change them, or assign your own to the
     * meshes. */
    readonly materials: Material[];
    /** Resolves when the whole pack is loaded. */
    load(source: PackSource): Promise<this>;
    /** Call before each renderer.render: advances time by seconds and deforms the character for the camera. */
    update(seconds: number, camera: Camera): void;
    /** Frees its GL objects and memory; the context stays. */
    dispose(): void;
}
