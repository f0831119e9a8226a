// SPDX-License-Identifier: GPL-3.0-or-later
// What the program put into the page: a list of files, each as base64 of its raw deflate.

/** The page's list: [{name, files: [{id, size}], report}]. */
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

/** The bytes of one embedded file. */
export async function embeddedBytes({ id, size }) {
  if (!globalThis.DecompressionStream)
    throw new Error("this browser is too old to unpack the file: use one of 2023 or later");
  const packed = decodeBase64(document.getElementById(id).textContent);
  const stream = new DecompressionStream("deflate-raw");
  const writer = stream.writable.getWriter();
  writer.write(packed).catch(() => {});  // the reader below tells
  writer.close().catch(() => {});
  const bytes = new Uint8Array(size);
  let at = 0;
  const reader = stream.readable.getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    bytes.set(part.value, at);
    at += part.value.length;
  }
  if (at !== size) throw new Error("the page is not complete");
  return bytes;
}
