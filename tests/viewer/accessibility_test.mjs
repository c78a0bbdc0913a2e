// SPDX-License-Identifier: MIT
// Pages with one fault each: that the check of accessibility sees it.
import assert from "node:assert/strict";
import { checkAccessibility } from "./accessibility.mjs";
import { openPage } from "./browser.mjs";

const table = (caption, head) => `<table>${caption}<thead><tr><th scope="col">x</th><th scope="col">y</th></tr></thead><tbody><tr>${head}<td>1</td></tr></tbody></table>`;
const cases = [
  [`<h1>a</h1><button>b</button>${table("<caption>c</caption>", '<th scope="row">r</th>')}<a href="#">c</a>`, null],
  ["<button></button>", "a button has no name"],
  [table("", '<th scope="row">r</th>'), "a table has no caption"],
  [table("<caption>c</caption>", "<td>r</td>"), 'the table "c" has no rowheader'],
  ['<img src="data:image/gif;base64,R0lGODlhAQABAAAAACw=" width="9" height="9">', "1 pictures have no alternative"],
  ["<style>button:focus { outline: none }</style><button>a</button>", 'the focus of button "a" is not seen'],
  ['<input aria-label="x" onkeydown="event.preventDefault()"><button>c</button>', 'Tab leads to input "x", number 0 instead of 1 of 2'],
  ['<p style="color: #aaa; background: #fff">pale</p>', '"pale" has a contrast of 2.3'],
  ['<div tabindex="0">x</div>', "what is a generic takes the focus: "],
  ["<h1>a</h1><h3>b</h3>", 'the heading "b" skips a level'],
];

const { browser, page } = await openPage({ withoutWebGL: true });
try {
  for (const [body, complaint] of cases) {
    await page.setContent(`<!doctype html><html lang="en"><head><title>t</title></head><body><header></header><main>${body}</main><footer></footer></body></html>`);
    const { complaints } = await checkAccessibility(page);
    if (complaint === null) assert.deepEqual(complaints, []);
    else assert.ok(complaints.includes(complaint), `${body}: ${complaints}`);
  }
} finally {
  await browser.close();
}
console.log("every fault is seen");
