// SPDX-License-Identifier: GPL-3.0-or-later
// What the page leaves out of a frame, and when. Usage: node --test quality_test.js
import assert from "node:assert/strict";
import { test } from "node:test";
import { countBefore, sorted } from "../../viewer/src/order.js";
import { Quality } from "../../viewer/src/quality.js";

// Frames of one length while something moves; then a pause. Returns the time.
function move(quality, now, frames, interval) {
  for (let i = 0; i < frames; ++i) quality.changed((now += interval));
  return now;
}
function pause(quality, now, length) {
  let drawn = 0;
  for (const end = now + length; now < end;) drawn += quality.rests((now += 16));
  return { now, drawn };
}

test("a quick machine draws everything, always", () => {
  const levels = [];
  const quality = new Quality((level) => levels.push(level));
  move(quality, 0, 500, 17);
  assert.deepEqual(levels, []);
});

test("slow frames lower the quality step by step, very slow ones at once", () => {
  const quality = new Quality(() => {});
  let now = move(quality, 0, 6, 60);
  assert.equal(quality.level, 1);
  now = move(quality, now, 20, 60);
  assert.equal(quality.level, 3);
  const other = new Quality(() => {});
  move(other, 0, 4, 400);
  assert.equal(other.level, 3);
});

test("when all is still everything is drawn once more, and the next motion starts low", () => {
  const quality = new Quality(() => {});
  let now = move(quality, 0, 10, 400);
  let rest = pause(quality, now, 200);
  assert.equal(rest.drawn, 0);
  rest = pause(quality, rest.now, 1000);
  assert.equal(rest.drawn, 1);
  assert.equal(quality.level, 0);
  now = move(quality, rest.now, 1, 16);
  assert.equal(quality.level, 3);
});

test("a machine that was slow only for a while gets its quality back", () => {
  const quality = new Quality(() => {});
  let now = move(quality, 0, 10, 400);
  for (let i = 0; i < 3; ++i) now = pause(quality, move(quality, now, 30, 17), 1000).now;
  move(quality, now, 30, 17);
  assert.equal(quality.level, 0);
});

test("a pause between two changes is no slow frame", () => {
  const quality = new Quality(() => {});
  let now = 0;
  for (let i = 0; i < 20; ++i) {
    quality.changed((now += 16));
    ({ now } = pause(quality, now, 100));
  }
  assert.equal(quality.level, 0);
});

test("spans are sorted by time, and counted up to one", () => {
  const list = Uint32Array.of(10, 11, 12, 20, 21, 22, 23, 24, 25, 30, 31, 32);
  const spans = [
    { part: 0, start: 0, count: 3 },
    { part: 1, start: 3, count: 6 },
    { part: 2, start: 9, count: 3 },
  ];
  const keys = [0.5, Infinity, -Infinity];
  const result = sorted(list, spans, ({ part }) => keys[part]);
  assert.deepEqual([...result.list], [30, 31, 32, 10, 11, 12, 20, 21, 22, 23, 24, 25]);
  assert.deepEqual(
    spans.map(({ start }) => start),
    [3, 6, 0],
  );
  for (const [time, count] of [
    [0, 3],
    [0.5, 3],
    [0.51, 6],
    [1e9, 6],
  ])
    assert.equal(countBefore(result, time), count);
  assert.equal(
    countBefore(
      sorted(new Uint32Array(0), [], () => 0),
      1,
    ),
    0,
  );
});
