// microphone.js: an AudioWorklet that passes the microphone's samples to the page, 10 ms at a time.
'use strict';

registerProcessor('microphone', class extends AudioWorkletProcessor {
    constructor() {
        super();
        this.samples = new Float32Array(Math.round(sampleRate / 100));
        this.count = 0;
    }

    // Mix the channels into one. Returns true: continue.
    process([channels]) {
        for (let i = 0; channels.length && i < channels[0].length; i++) {
            let sum = 0;
            for (const channel of channels) sum += channel[i];
            this.samples[this.count++] = sum / channels.length;
            if (this.count === this.samples.length) {
                this.port.postMessage(this.samples.slice());
                this.count = 0;
            }
        }
        return true;
    }
});
