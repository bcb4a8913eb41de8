// react.tsx: the element in JSX of React 19; it is compiled, never run.
import { useRef } from 'react';
import type { NohCharacter } from 'noh-character/react';

export function Face() {
    const face = useRef<NohCharacter>(null);
    return <noh-character ref={face} src="face.nohz" cameraOrbit autoLife degrees={40} className="face"
        onload={(event) => console.log(event.detail.whole)} onClick={() => face.current?.setWeight('smile', 1)} />;
}
export const shapeless = <noh-character src="face.nohz" shadow="blob" onerror={({ detail }) => console.log(detail.message)} />;
export const marked = <noh-character src="face.nohz" background="transparent"><button slot="hotspot-nose" data-joint="head" data-position="0 10cm 9cm">nose</button></noh-character>;
// @ts-expect-error there is no such shadow
export const wrong = <noh-character src="face.nohz" shadow="long" />;
// @ts-expect-error there is no such attribute
export const unknown = <noh-character source="face.nohz" />;
