// pixels.js: how many pixels a character is drawn with: all of them, or fewer across while it moves and frames take long, as
// they do where no GPU draws; and whether one does.

const looksAt = 16, atLeast = 5, enough = 1200; // frames whose mean counts; fewer, if they took so many ms: browsers ask for several at once
const underWay = 5; // frames after a change, which may be of what was before
const tooLong = 50, aim = 36; // ms of a frame
const drop = 0.4, rise = 1.25; // at once
const fewest = 0.4; // of the pixels across
const helps = 0.9; // of a frame's time: what fewer pixels must bring it down to
const waits = 20000; // ms until what did not work is tried again

// Whether a renderer is a program, by the name that a context gives it.
export const isSoftware = (renderer) => /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer);

export class Pixels {
    constructor() {
        // most: what was too many, until then; vain: fewer were no help, until then
        Object.assign(this, { share: 1, frames: -underWay, sum: 0, before: null, most: Infinity, until: 0, vain: 0 });
    }

    // Another canvas, or another scene: what was learnt no longer holds.
    forget() { Object.assign(this, new Pixels()); }

    // A frame that followed another at once did so after so many ms. Returns whether the share has changed.
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
        if (before && mean > before.mean * helps && mean > tooLong) { // it is not the pixels that take long
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
