// pixels.js: the resolution of a character: full, or reduced while it moves and frames are slow, as without a GPU; and
// whether there is a GPU.

const looksAt = 16, atLeast = 5, enough = 1200; // frames to average; at least this many after `enough` ms, because browsers request several at once
const underWay = 5; // frames ignored after a change, because they may be older
const tooLong = 50, aim = 36; // ms per frame
const drop = 0.4, rise = 1.25; // per change
const fewest = 0.4; // share of the full width
const helps = 0.9; // a lower resolution must reduce a frame's time to this share
const waits = 20000; // ms before a failed change is tried again

// Whether a renderer is software, by its name in a context.
export const isSoftware = (renderer) => /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer);

export class Pixels {
    constructor() {
        // most: too high a resolution, and until when; vain: until when a lower one is known not to help
        Object.assign(this, { share: 1, frames: -underWay, sum: 0, before: null, most: Infinity, until: 0, vain: 0 });
    }

    // Another canvas or scene: measurements are no longer valid.
    forget() { Object.assign(this, new Pixels()); }

    // Report the ms between two consecutive frames. Returns whether the share has changed.
    tell(ms, now) {
        if (++this.frames <= 0) return false;
        this.sum += ms;
        if (this.frames < looksAt && (this.frames < atLeast || this.sum < enough)) return false;
        const mean = this.sum / this.frames, { share } = this;
        this.frames = this.sum = 0;
        this.share = this.judge(mean, now);
        if (this.share !== share) this.frames = -underWay;
        return this.share !== share;
    }

    judge(mean, now) {
        const { share, before } = this, more = Math.min(1, share * rise);
        this.before = null;
        if (before && mean > before.mean * helps && mean > tooLong) { // the time does not depend on pixels
            this.vain = now + waits;
            return before.share;
        }
        if (mean > tooLong && share > fewest && now >= this.vain) {
            Object.assign(this, { before: { share, mean }, most: share, until: now + waits });
            return Math.max(fewest, share * Math.max(drop, Math.sqrt(aim / mean)));
        }
        return mean * (more / share) ** 2 < aim && (more < this.most || now >= this.until) ? more : share;
    }
}
