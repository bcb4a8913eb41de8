// compare_fours.js: what compare.js makes of its measurements. What targets add is small compared with a frame, and
// whatever else runs takes more than they do. So frames come in fours, one after another: without targets, with, with,
// without; the middle one of the differences counts. Fours with a frame that took a third longer than the quickest
// tenth are left out: something else had the machine. What is left falls into six batches in the order of time, so that
// their quartiles tell of what drifts, too.
'use strict';

const batches = 6, enough = 10 * batches;
const disturbed = 4 / 3; // of the quickest tenth of the frames
const within = 0.1;

const at = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];
const median = (values) => at(values, 0.5);
const spread = (values) => (at(values, 0.75) - at(values, 0.25)) / 2 / Math.abs(median(values));

// Of a four: frames without targets, with them, and what they add.
const restOf = ([a, , , d]) => [a, d], morphedOf = ([, b, c]) => [b, c], addedOf = ([a, b, c, d]) => [(b + c - a - d) / 2];

function quiet(fours) {
    const kinds = [restOf, morphedOf], most = kinds.map((kind) => disturbed * at(fours.flatMap(kind), 0.1));
    return fours.filter((four) => kinds.every((kind, i) => Math.max(...kind(four)) <= most[i]));
}

// A value for each batch.
function inBatches(fours, kind) {
    const left = quiet(fours), from = (b) => Math.floor(b * left.length / batches);
    return Array.from({ length: batches }, (_, b) => median(left.slice(from(b), from(b + 1)).flatMap(kind)));
}

const isSettled = (fours, kinds) => quiet(fours).length >= enough && kinds.every((kind) => spread(inBatches(fours, kind)) <= within);

module.exports = { restOf, morphedOf, addedOf, at, median, spread, quiet, inBatches, isSettled, enough };
