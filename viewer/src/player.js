// SPDX-License-Identifier: GPL-3.0-or-later
// The time shown: played, scrubbed, stepped.

export class Player {
  constructor(onTime) {
    this.onTime = onTime;
    this.reset([0]);
  }

  reset(times) {
    this.times = times;
    this.duration = times[times.length - 1];
    this.time = 0;
    this.rate = 1;
    this.isPlaying = false;
  }

  go(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    this.onTime(this.time);
  }

  /** To a time, and stay there. */
  jump(time) {
    this.isPlaying = false;
    this.go(time);
  }

  toggle() {
    this.isPlaying = !this.isPlaying && this.duration > 0;
    if (this.isPlaying && this.time >= this.duration) this.time = 0;
    this.onTime(this.time);
  }

  /** Seconds of the clock have passed. */
  advance(elapsed) {
    if (!this.isPlaying) return;
    const next = this.time + elapsed * this.rate;
    if (next >= this.duration) this.isPlaying = false;
    this.go(next);
  }

  /** To the step of the run so many further on. */
  step(count) {
    this.isPlaying = false;
    let low = 0,
      high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= this.time + 1e-9) low = middle + 1;
      else high = middle;
    }
    this.go(this.times[Math.min(Math.max(low - 1 + count, 0), this.times.length - 1)]);
  }
}
