// Types of noh-character.

/** A pack, `.noh`, or its wire form, `.nohz`: an address, a Response, a file, or bytes. */
export type PackSource = string | URL | Response | Promise<Response> | Blob | ArrayBuffer | ArrayBufferView;

export type Layer = 'body' | 'face';
export type Shadow = 'on' | 'off' | 'blob';
/** What the camera frames: the face with its hair, the upper part of a body, or all of the figures. */
export type View = 'face' | 'upper' | 'full';
/** The blurred light, a gradient, grey, or a CSS colour: `transparent` shows the page. */
export type Background = 'light' | 'gradient' | 'plain' | 'transparent' | (string & {});
/** The accumulation path of targets: `auto` selects the best for this context. */
export type MorphPath = 'auto' | 'mrt' | 'per-layer' | 'gather' | 'direct' | 'cpu' | 'blend';

export interface Clip { readonly name: string; readonly seconds: number }
export interface PlayOptions {
    layer?: Layer;
    /** Seconds of transition from the shown pose; default 0.3. With 0 the clip starts at `time`. */
    fade?: number;
    /** Seconds into the clip. */
    time?: number;
}
export interface Light {
    /** `plain`, `white`, `studio`, `room` or `sky`. */
    light: string;
    /** Rotation, -180 to 180. */
    degrees: number;
    shadow: Shadow;
    /** Whether a shadow also falls on a floor under a body; default true. */
    floor: boolean;
    tonemap: boolean;
    background: Background;
    /** Use the light precomputed for each vertex when the pack was built. */
    transfer: boolean;
}
/** In bytes. */
export interface Memory {
    /** The WebAssembly memory, which cannot grow: pack, block, static data and stack, in pages of 64 KiB. */
    readonly all: number;
    readonly pack: number;
    /** The block of the stage. */
    readonly room: number;
    /** The used part of the block. */
    readonly cpu: number;
    readonly gpu: number;
    readonly parts: readonly { readonly name: string; readonly cpu: number; readonly gpu: number }[];
}

/** A callback key that a clip has passed. */
export interface KeyDetail { readonly name: string; readonly clip: string; readonly layer: Layer; readonly weight: number; readonly character: number }
/** `all`: 0 if the server sends no length. `shows`: 0 nothing yet, 1 the coarsest levels, 2 everything. */
export interface ProgressDetail {
    readonly taken: number;
    readonly all: number;
    readonly shows: 0 | 1 | 2;
    /** Bytes of the program so far, uncompressed, before the pack is read. */
    readonly program?: number;
}
export interface CharacterEvents {
    load: CustomEvent<{ whole: boolean }>;
    progress: CustomEvent<ProgressDetail>;
    key: CustomEvent<KeyDetail>;
    /** `vertex`: of the mesh, nearest to the point; -1 if nothing was hit. With `data-vertex="MESH VERTEX"` a hotspot stays
     * there. */
    pick: CustomEvent<{ mesh: string; joint: string; vertex: number }>;
    push: CustomEvent<{ error: string }>;
    speech: CustomEvent<{ words: string; speaks: boolean; source: string }>;
    /** What is said now, '' at the end. `silent`: without a voice. */
    caption: CustomEvent<{ words: string; silent: boolean }>;
    /** A word begins, at this position of the text; -1 if unknown. */
    word: CustomEvent<{ word: string; at: number }>;
    pause: CustomEvent<{ paused: boolean }>;
    light: CustomEvent<Light>;
    frame: CustomEvent<{ seconds: number }>;
    lost: CustomEvent<null>;
    restored: CustomEvent<null>;
}

/** A sentence, which a voice of the browser says, or the mouth alone; a sound, to which the mouth moves: a file, an
 * address, bytes, or decoded; a stream, which is not played; an element that plays; or samples, -1 to 1, as they come. */
export type SpeechSource = string | Blob | URL | ArrayBuffer | AudioBuffer | MediaStream | HTMLMediaElement | AsyncIterable<Float32Array>;
export interface SpeechOptions {
    /** Mouth shapes of a sound, in the order of noh_viseme, and when each begins; default: what the ear hears. */
    visemes?: readonly { viseme: number; ms: number }[];
    /** When each word begins, for captions and events. */
    words?: readonly { word: string; ms: number }[];
    /** An emotion while it is said. */
    mood?: string;
    /** Of samples, in Hz, 8000 to 48000; default 24000. */
    rate?: number;
    /** At once, instead of what is said now and of what waits. */
    interrupt?: boolean;
}

/** A voice of your own: makes the sound of a sentence, with the times of mouth shapes and words, if it has them; otherwise the
 * ear hears the sound. If it fails, a voice of the browser says the sentence. */
export type Voice = (text: string) => VoiceSound | VoiceSpeech | Promise<VoiceSound | VoiceSpeech>;
export type VoiceSound = Exclude<SpeechSource, string | MediaStream | HTMLMediaElement>;
export interface VoiceSpeech extends Pick<SpeechOptions, 'visemes' | 'words' | 'rate'> { sound: VoiceSound }

/** `all`, the default: noh.wasm; `body`, without falls and three.js: body.wasm; `face`, also without springs, hair and bodies
 * that stand: face.wasm; or an address. */
export type Program = 'all' | 'body' | 'face' | (string & {});
/** How much is computed at each pixel: `auto`, the default: `phone`, which approximates, on slow GPUs of phones, else `full`. */
export type Tier = 'auto' | 'full' | 'phone';

export interface CharacterOptions extends Partial<Light> {
    program?: Program | URL;
    tier?: Tier;
    path?: MorphPath;
    /** Number of characters side by side, 1 to 16. */
    characters?: number;
    /** Whether faces and springs get memory of their own. */
    alive?: boolean;
    /** Pixels across, instead of the canvas's own size. */
    size?: number;
    /** `auto`, the default: reduced resolution while the figure moves and frames are slow, full resolution at rest. Not
     * with `size`. */
    pixels?: 'auto' | 'all';
    /** Whether the camera follows a walking figure. */
    follows?: boolean;
    /** What the camera frames; default: all of the figures. */
    view?: View;
    /** Says sentences in place of the browser's voices. */
    voice?: Voice | null;
    level?: number;
    speed?: number;
    paused?: boolean;
    /** Nothing moves by itself. */
    calm?: boolean;
    emotion?: string | null;
    amount?: number;
    wrinkles?: number;
    hair?: boolean;
    wind?: number;
}

/** A character on a canvas of your own. */
export class Character extends EventTarget {
    constructor(canvas: HTMLCanvasElement, options?: CharacterOptions);
    readonly canvas: HTMLCanvasElement;
    /** Whether a pack is shown, if only by its coarsest levels. */
    readonly loaded: boolean;
    readonly whole: boolean;
    readonly lost: boolean;
    readonly clips: readonly Clip[];
    readonly targets: readonly string[];
    readonly emotions: readonly string[];
    readonly lights: readonly string[];
    readonly memory: Memory;
    /** What `tier` comes to on this GPU. */
    readonly tier: 'full' | 'phone';
    time: number;
    speed: number;
    paused: boolean;
    level: number;
    alive: boolean;
    voice: Voice | null;
    /** Whether the resolution is reduced while the figure moves and frames are slow. */
    sparing: boolean;
    /** Resolution of the next frame, as a share of the full width. */
    readonly share: number;
    load(source: PackSource): Promise<void>;
    /** Calls with a name that the pack lacks throw an error. */
    play(name: string | null, options?: PlayOptions): void;
    setWeight(target: string, weight: number): void;
    releaseWeight(target: string): void;
    releaseWeights(): void;
    weight(target: string): number;
    setLight(light: Partial<Light>): void;
    turnLight(degrees: number): void;
    setWrinkles(amount: number): void;
    setHair(shown: boolean, wind: number): void;
    shake(): void;
    /** A point of the page, in pixels. */
    lookAt(x: number, y: number): void;
    lookAhead(): void;
    feel(emotion: string | null, amount?: number): void;
    /** Fifteen weights of mouth shapes, in the order of noh_viseme; null: silence. */
    setMouth(weights: ArrayLike<number> | null): void;
    push(x?: number, y?: number): string;
    /** What `fit` frames. */
    view: View;
    fit(): void;
    home(): void;
    zoom(by: number): void;
    turn(azimuth: number, elevation: number): void;
    pan(x: number, y: number): void;
    /** Advance time by seconds and draw immediately. */
    advance(seconds: number): void;
    redraw(): void;
    dispose(): void;
    readonly speech: { speak(what: SpeechSource, options?: SpeechOptions): Promise<boolean>; listen(): Promise<void>; stop(): void; readonly speaks: boolean };
    addEventListener<K extends keyof CharacterEvents>(type: K, listener: (event: CharacterEvents[K]) => void, options?: boolean | AddEventListenerOptions): void;
    addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

export interface NohCharacterEvents extends CharacterEvents {
    error: CustomEvent<{ message: string }>;
    /** A detail of a visitor's model that was left out. */
    warning: CustomEvent<{ message: string }>;
}

export interface Point { readonly x: number; readonly y: number; readonly z: number }
/** A hotspot in the last frame. */
export interface HotspotView {
    /** In the world, in model units. */
    readonly position: Point;
    /** null: none is given. */
    readonly normal: Point | null;
    /** In pixels of the element, from its top left corner; z: depth, -1 to 1. */
    readonly canvasPosition: Point;
    /** Whether it is in the picture, and its normal, if it has one, faces the camera. */
    readonly facingCamera: boolean;
}

/** The attributes of `<noh-character>`, as properties. */
export interface NohCharacterProperties {
    /** A pack, or a model in one file (.glb, .vrm, .fbx), which is converted in a worker and kept in the browser. */
    src: string;
    clip: string;
    /** A second clip, played over the first one on the face. */
    face: string;
    light: string;
    degrees: number;
    shadow: Shadow;
    floor: 'on' | 'off';
    tonemap: 'on' | 'none';
    background: Background;
    level: number;
    speed: number;
    emotion: string;
    alt: string;
    /** Address of a picture that is shown until the first frame, unless there is a slot `poster`. */
    poster: string;
    /** `lazy`: loads when the visitor scrolls to it. */
    loading: 'auto' | 'lazy' | 'eager';
    /** Set it before the element is added to the page. */
    program: Program;
    /** Set it before the element is added to the page. */
    tier: Tier;
    path: MorphPath;
    pixels: 'auto' | 'all';
    characters: number;
    view: View;
    cameraOrbit: boolean;
    /** Limits of the camera, "theta phi radius" as in model-viewer: `-60deg 70deg 50%`; `auto`: none of its own. */
    minCameraOrbit: string;
    maxCameraOrbit: string;
    autoLife: boolean;
    /** Whether what is said is shown; without a voice it always is. */
    captions: boolean;
    gaze: boolean;
    drop: boolean;
    paused: boolean;
}

export interface NohCharacter extends NohCharacterProperties {}
/** `<noh-character src="x.noh" clip="walk" light="room" camera-orbit auto-life>`. Methods that return a promise may be
 * called at any time: they wait for the pack that is asked for, and reject if it lacks a name. */
export class NohCharacter extends HTMLElement {
    /** Says sentences in place of the browser's voices; null: none. */
    voice: Voice | null;
    /** Resolves to the element when the pack is shown, if only by its coarsest levels; rejects if it cannot be. The next
     * load makes another promise. */
    readonly ready: Promise<this>;
    /** Whether a pack is shown. */
    readonly loaded: boolean;
    readonly whole: boolean;
    /** Error message; '' if there is none. */
    readonly error: string;
    time: number;
    readonly clips: readonly Clip[];
    readonly targets: readonly string[];
    readonly emotions: readonly string[];
    readonly memory: Memory | null;
    /** null while the element is not in a page. */
    readonly character: Character | null;
    /** Resolves to whether the pack is shown. */
    load(source: PackSource): Promise<boolean>;
    /** A pack, or a model (.glb, .gltf, .vrm, .fbx, .obj) with its files and clips (.bvh, .csv, .trc, .c3d, .vrma), converted in a worker. */
    open(files: Iterable<File>): Promise<boolean>;
    play(name: string | null, options?: PlayOptions): Promise<void>;
    setWeight(target: string, weight: number): Promise<void>;
    releaseWeight(target: string): Promise<void>;
    releaseWeights(): Promise<void>;
    /** 0 before a pack is shown. */
    weight(target: string): number;
    lookAt(x: number, y: number): Promise<void>;
    lookAhead(): Promise<void>;
    feel(emotion: string | null, amount?: number): Promise<void>;
    push(): Promise<string>;
    fit(): Promise<void>;
    /** A child with `slot="hotspot-NAME"`, by the name of its slot; null: it is not shown. The child has `data-visible` while
     * it faces the camera, and the event `hotspot-visibility` (`HotspotEvent`) when that changes. */
    queryHotspot(name: string): HotspotView | null;
    /** The present picture; default: PNG. */
    toBlob(options?: { mimeType?: string; quality?: number }): Promise<Blob | null>;
    /** Says it after what is said now. Resolves to whether all of it was said. */
    speak(what: SpeechSource, options?: SpeechOptions): Promise<boolean>;
    listen(): Promise<void>;
    setMouth(weights: ArrayLike<number> | null): Promise<void>;
    hush(): Promise<void>;
    dispose(): void;
    addEventListener<K extends keyof NohCharacterEvents>(type: K, listener: (event: NohCharacterEvents[K]) => void, options?: boolean | AddEventListenerOptions): void;
    addEventListener<K extends keyof HTMLElementEventMap>(type: K, listener: (event: HTMLElementEventMap[K]) => void, options?: boolean | AddEventListenerOptions): void;
    addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

export type HotspotEvent = CustomEvent<{ visible: boolean }>;

/** Let the canvas move the camera. Returns a function that ends it. */
export function addPointers(canvas: HTMLCanvasElement, character: Character, wheel?: (event: WheelEvent) => boolean, asked?: () => boolean): () => void;
/** The faces look at the pointer while it is over the canvas. Returns a function that ends it. */
export function addGaze(canvas: HTMLCanvasElement, character: Character, asked?: () => boolean): () => void;
/** Convert a model (.glb, .gltf, .vrm, .fbx, .obj) with its files and clips (.bvh, .csv, .trc, .c3d, .vrma) to a pack, in a worker. `tell` takes
 * progress, `warn` each warning. `options`: as for `noh build`. */
export function convert(files: readonly File[], settings?: { tell?: (words: string) => void; warn?: (words: string) => void; options?: readonly string[] }): Promise<Uint8Array>;
/** Mouth shapes of a text, letter by letter. */
export function shapesOfText(words: string, rate: number): { at: number; ms: number; shape: number }[];

declare global {
    interface HTMLElementTagNameMap { 'noh-character': NohCharacter }
}
