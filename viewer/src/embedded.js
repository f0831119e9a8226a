// SPDX-License-Identifier: GPL-3.0-or-later
// What the program put into the page: a list of files, each as base64 of its raw deflate.

/** The page's list: [{name, files: [{id, size, words}], report}]. */
export function embeddedList() {
  const element = document.getElementById("sunder-list");
  return element ? JSON.parse(element.textContent) : [];
}

function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// From `start` on the first bytes of all words of four come first, then the second, third, fourth:
// so they pack better. What is left of the last word follows as it is.
function inWords(bytes, start) {
  const count = Math.floor((bytes.length - start) / 4);
  const result = new Uint8Array(bytes.length);
  result.set(bytes.subarray(0, start));
  result.set(bytes.subarray(start + 4 * count), start + 4 * count);
  for (let k = 0; k < 4; ++k) {
    const plane = bytes.subarray(start + k * count, start + (k + 1) * count);
    for (let i = 0, to = start + k; i < count; ++i, to += 4) result[to] = plane[i];
  }
  return result;
}

/** The bytes of one embedded file. */
export async function embeddedBytes({ id, size, words }) {
  if (!globalThis.DecompressionStream)
    throw new Error("this browser is too old to unpack the file: use one of 2023 or later");
  const packed = decodeBase64(document.getElementById(id).textContent);
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
  return inWords(bytes, words);
}
