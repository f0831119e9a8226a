// SPDX-License-Identifier: GPL-3.0-or-later
// What the program put into the page: a list of files, each as base64 of its raw deflate.

/** The page's list: [{name, files: [{id, size, words}], report}]. */
export function embeddedList() {
  const element = document.getElementById("sunder-list");
  return element ? JSON.parse(element.textContent) : [];
}

const kMany = 2 ** 20; // bytes or characters at a time

// In slices of whole groups of four characters.
async function decodeBase64(text, size, breath) {
  const bytes = new Uint8Array(size);
  let to = 0;
  for (let at = 0; at < text.length; at += kMany) {
    const part = text.slice(at, at + kMany);
    if (Uint8Array.fromBase64) {
      const some = Uint8Array.fromBase64(part);
      (bytes.set(some, to), (to += some.length));
    } else {
      const binary = atob(part);
      for (let i = 0; i < binary.length; ++i) bytes[to++] = binary.charCodeAt(i);
    }
    if (breath.isDue) await breath.take();
  }
  return bytes;
}

// From `start` on the first bytes of all words of four come first, then the second, third, fourth:
// so they pack better. What is left of the last word follows as it is.
async function inWords(bytes, start, breath) {
  const count = Math.floor((bytes.length - start) / 4);
  const result = new Uint8Array(bytes.length);
  result.set(bytes.subarray(0, start));
  result.set(bytes.subarray(start + 4 * count), start + 4 * count);
  for (let k = 0; k < 4; ++k) {
    const plane = bytes.subarray(start + k * count, start + (k + 1) * count);
    for (let i = 0, to = start + k; i < count;) {
      for (const end = Math.min(i + kMany, count); i < end; ++i, to += 4) result[to] = plane[i];
      if (breath.isDue) await breath.take();
    }
  }
  return result;
}

/** The bytes of one embedded file; `breath`: see breath.js. */
export async function embeddedBytes({ id, size, words }, breath) {
  if (!globalThis.DecompressionStream)
    throw new Error("this browser is too old to unpack the file: use one of 2023 or later");
  const text = document.getElementById(id).textContent.trim();
  const packed = await decodeBase64(
    text,
    (text.length / 4) * 3 - text.match(/=*$/)[0].length,
    breath,
  );
  const stream = new DecompressionStream("deflate-raw");
  const writer = stream.writable.getWriter();
  writer.write(packed).catch(() => {}); // the reader below tells
  writer.close().catch(() => {});
  const bytes = new Uint8Array(size);
  let at = 0;
  const reader = stream.readable.getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    bytes.set(part.value, at);
    at += part.value.length;
  }
  if (at !== size) throw new Error("the page is not complete");
  return inWords(bytes, words, breath);
}
