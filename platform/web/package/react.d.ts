// Types of <noh-character> in JSX, for React 19: import 'noh-character/react'.
import type { DetailedHTMLProps, HTMLAttributes } from 'react';
import type { NohCharacter, NohCharacterEvents, NohCharacterProperties } from './index.js';
export * from './index.js';

type NohEvents = { [K in keyof NohCharacterEvents as `on${K}`]?: (event: NohCharacterEvents[K]) => void };
type NohAttributes = { [K in keyof NohCharacterProperties]?: NohCharacterProperties[K] };

declare module 'react' {
    namespace JSX {
        interface IntrinsicElements {
            'noh-character': Omit<DetailedHTMLProps<HTMLAttributes<NohCharacter>, NohCharacter>, keyof NohAttributes> & NohAttributes & NohEvents;
        }
    }
}
