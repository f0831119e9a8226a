// SPDX-License-Identifier: GPL-3.0-or-later
// node validate.js FILE…: runs the Khronos validator over .glb and .gltf files, one line per file.
// Exit 1 if a file has an error or a warning. Set up once with: npm install
const fs = require('fs');
const path = require('path');
const validator = require('gltf-validator');

async function validate(file) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    maxIssues: 0,
    externalResourceFunction: (uri) =>
        fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri)))
            .then((bytes) => new Uint8Array(bytes)),
  });
  const issues = report.issues;
  const counts = new Map();
  for (const message of issues.messages) {
    const key = `${['error', 'warning', 'info', 'hint'][message.severity]} ${message.code}`;
    const seen = counts.get(key) || { count: 0, first: `${message.pointer}: ${message.message}` };
    counts.set(key, { count: seen.count + 1, first: seen.first });
  }
  console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ` +
              `${issues.numInfos} infos, ${issues.numHints} hints`);
  for (const [key, { count, first }] of counts) console.log(`  ${count} × ${key} ${first}`);
  return issues.numErrors + issues.numWarnings === 0;
}

(async () => {
  const files = process.argv.slice(2);
  if (files.length === 0) {
    console.error('usage: node validate.js FILE…');
    process.exit(2);
  }
  let sound = true;
  for (const file of files) sound = (await validate(file)) && sound;
  process.exit(sound ? 0 : 1);
})().catch((error) => {
  console.error(error);
  process.exit(1);
});
