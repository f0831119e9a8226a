// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of a page. Usage: node picture.js PAGE.html QUERY OUT.png
import { resolve } from "node:path";
import { launch, openPage, shoot } from "./browser.js";

const [page, query, out] = process.argv.slice(2);
const chromium = await launch();
await shoot(await openPage(chromium, resolve(page), { query, scale: 2 }), { all: true, path: out });
await chromium.browser.close();
