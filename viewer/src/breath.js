// SPDX-License-Identifier: GPL-3.0-or-later
// Long work in slices, so that the page answers meanwhile.

const kSlice = 20; // ms

function nextTask() {
  if (globalThis.scheduler?.yield) return scheduler.yield();
  return new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => (port1.close(), done());
    port2.postMessage(null);
  });
}

/** Counts the time since the browser last had its turn. */
export class Breath {
  constructor() {
    this.start = performance.now();
  }

  /** True if a slice is over: then `await breath.take()`. */
  get isDue() {
    return performance.now() - this.start > kSlice;
  }

  async take() {
    await nextTask();
    this.start = performance.now();
  }
}
