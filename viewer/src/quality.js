// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps pictures coming on a slow machine: while something moves and frames take long, they are
// drawn with less; when all is still, once more with everything.

const kSlow = 40; // ms a frame
const kQuick = 17.5; // ms a frame
const kJudged = 4; // frames that are looked at
const kEnough = 250; // ms of frames that are enough for it
const kStill = 250; // ms without a change after which all is still

const kLeast = 3; // 0: everything. 1: shadows late. 2: no shadows or edges. 3: coarse pixels, too

export class Quality {
  /** `onLevel(level)` is called when it changes. */
  constructor(onLevel) {
    Object.assign(this, { onLevel, level: 0, wanted: 0, intervals: [], last: 0, still: 0 });
  }

  /** What moves is to be drawn at this level from the start. */
  begin(level) {
    this.wanted = level;
    this.set(level);
  }

  /** A frame is about to be drawn because something changed. */
  changed(now) {
    if (this.still === null) this.judge(now - this.last);
    else if (now - this.still > kStill) this.intervals = [];
    // One change alone is drawn with everything where that is not very slow; what goes on starts
    // as the last motion ended.
    if (this.still === null || this.level > 0 || this.wanted > 1) this.set(this.wanted);
    this.last = now;
    this.still = null;
  }

  judge(interval) {
    this.intervals.push(interval);
    const { length } = this.intervals;
    if (length < kJudged && this.intervals.reduce((a, b) => a + b) < kEnough) return;
    const typical = this.intervals.sort((a, b) => a - b)[length >> 1];
    this.intervals = [];
    if (typical > kSlow)
      this.wanted = Math.min(this.wanted + (typical > 3 * kSlow ? 2 : 1), kLeast);
    this.isQuick = typical < kQuick;
  }

  /** Nothing changed. True if everything must be drawn once more, now that nothing moves. */
  rests(now) {
    this.still ??= now;
    if (this.level === 0 || now - this.still < kStill) return false;
    if (this.isQuick) this.wanted = Math.max(this.wanted - 1, 0);
    this.set(0);
    return true;
  }

  set(level) {
    if (level === this.level) return;
    this.level = level;
    this.onLevel(level);
  }
}
