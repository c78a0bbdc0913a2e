// SPDX-License-Identifier: MIT
#include "roomscribe/report/report_style.hpp"

#include <fmt/format.h>

#include "roomscribe/model/label.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view rules = R"css(
:root {
  color-scheme: light dark;
  --page: #fcfcfa; --panel: #f4f4f0; --ink: #1d2125; --soft: #62686f; --line: #e2e2dc;
  --good: #2b7a4b; --warn: #a15c00; --bad: #b3342b; --halo: #fcfcfa; --bar: #8fa7b8;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #15181b; --panel: #1d2125; --ink: #e6e8ea; --soft: #9aa2aa; --line: #2e343a;
    --good: #6cc492; --warn: #e0a84e; --bad: #ef8078; --halo: #15181b; --bar: #5d7788;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0 auto; padding: 4.5rem 2rem 5rem; max-width: 74rem;
  background: var(--page); color: var(--ink);
  font: 1rem/1.6 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif;
  font-variant-numeric: tabular-nums;
}
h1 { margin: 0 0 .75rem; font-size: 2.35rem; line-height: 1.15; font-weight: 650;
  letter-spacing: -.02em; text-wrap: balance; overflow-wrap: anywhere; }
h2 { margin: 4.5rem 0 1.25rem; font-size: 1.4rem; line-height: 1.25; font-weight: 620;
  letter-spacing: -.01em; }
.lead { margin: 0; max-width: 46rem; font-size: 1.15rem; line-height: 1.55; color: var(--soft); }
.note { margin: 0 0 1rem; max-width: 46rem; color: var(--soft); }
.figures { display: flex; flex-wrap: wrap; justify-content: space-between;
  gap: 1.75rem 1.5rem; margin: 2.75rem 0 0; padding: 1.75rem 0 0; border-top: 1px solid var(--line); }
.figures div { display: flex; flex-direction: column-reverse; justify-content: flex-end; }
.figures dt { font-size: .85rem; color: var(--soft); }
.figures dd { margin: 0; font-size: 1.55rem; line-height: 1.25; font-weight: 600;
  letter-spacing: -.015em; white-space: nowrap; }
.figures small { font-size: .95rem; font-weight: 450; color: var(--soft); letter-spacing: 0; }
.checks { margin: 2.5rem 0 0; padding: 1.1rem 1.4rem; border-left: 3px solid var(--warn);
  background: var(--panel); border-radius: 0 .4rem .4rem 0; }
.checks h2 { margin: 0 0 .35rem; font-size: 1rem; }
.checks ul { margin: 0; padding-left: 1.1rem; }
.checks li { margin: .15rem 0; overflow-wrap: anywhere; }

figure { margin: 0 0 3.5rem; }
figcaption { margin: 0 0 1rem; }
figcaption strong { display: block; font-size: 1.05rem; font-weight: 600; }
figcaption span { color: var(--soft); }
.plot { max-width: max(24rem, calc(var(--aspect) * 44rem)); }
.pieces { display: grid; grid-template-columns: repeat(auto-fill, minmax(20rem, 1fr)); gap: 0 2.5rem; }
.pieces figure { margin-bottom: 2rem; }
.pieces .scale { display: none; }
.pieces .plot { max-width: max(11rem, calc(var(--aspect) * 22rem)); }
.stages { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(24rem, 100%), 1fr));
  gap: 0 2rem; }
.stages figure { margin-bottom: 2rem; }
.faint img { opacity: .3; }
.stage-line { fill: none; stroke-width: 1.5; }
.drawing { display: block; max-width: 100%; height: auto; background: #fff; border-radius: .3rem; }
.elevations { display: flex; flex-wrap: wrap; gap: 0 2rem; align-items: flex-end; }
.elevations figure { margin: 0 0 2rem; max-width: 100%; }
.elevations figcaption { margin: 0 0 .4rem; }
.elevation { display: block; max-width: 100%; height: auto; }
.elevation .face { fill: var(--panel); stroke: var(--ink); stroke-width: .25; }
.elevation .opening { fill: var(--page); stroke-width: .45; }
.elevation line { stroke: var(--soft); stroke-width: .15; }
.elevation text { fill: var(--ink); font-size: 2.5px; }
.frame { position: relative; margin: 0 0 1.9rem 2.6rem; }
.canvas { position: relative; aspect-ratio: var(--aspect); background: var(--panel);
  border-radius: .3rem; overflow: hidden; }
.canvas img, .canvas svg { position: absolute; inset: 0; width: 100%; height: 100%; display: block; }
.canvas svg * { vector-effect: non-scaling-stroke; }
.grid { stroke: var(--ink); stroke-opacity: .08; stroke-width: 1; fill: none; }
.shape { fill: transparent; stroke-width: 2; stroke-linejoin: round; }
.shape:hover { fill: var(--ink); fill-opacity: .12; }
.halo { fill: none; stroke: var(--halo); stroke-opacity: .75; stroke-width: 4.5;
  stroke-linejoin: round; }
.doubtful-shape { stroke-dasharray: 5 4; }
.room-shape { fill: none; stroke: var(--ink); stroke-width: 1; stroke-dasharray: 1 4;
  stroke-linecap: round; }
.tick { position: absolute; font-size: .75rem; line-height: 1; color: var(--soft); }
.tick-x { top: calc(100% + .6rem); transform: translateX(-50%); }
.tick-y { right: calc(100% + .5rem); transform: translateY(-50%); }
.tag { position: absolute; transform: translate(-50%, -50%); padding: .05rem .5rem;
  border-radius: 1rem; font-size: .8rem; font-weight: 550; white-space: nowrap;
  background: var(--page); color: var(--ink); opacity: .92; pointer-events: none; }
.station { position: absolute; transform: translate(-50%, -50%); width: 1.5rem; height: 1.5rem;
  border-radius: 50%; border: 2px solid var(--page); background: var(--ink); color: var(--page);
  font-size: .72rem; font-weight: 650; line-height: 1.2rem; text-align: center; }
.scale { position: absolute; right: .9rem; bottom: .8rem; border: 1.5px solid var(--ink);
  border-top: 0; height: .45rem; background: var(--panel);
  box-shadow: 0 -.55rem 0 .5rem var(--panel); }
.scale span { position: absolute; bottom: .55rem; left: 0; right: 0; text-align: center;
  font-size: .75rem; line-height: 1; }
.legend { display: flex; flex-wrap: wrap; gap: .35rem 1.5rem; margin: .75rem 0 0 2.6rem;
  padding: 0; list-style: none; font-size: .875rem; }
.legend span { color: var(--soft); }
.swatch { display: inline-block; width: .8em; height: .8em; margin-right: .5em;
  border-radius: .2em; vertical-align: -.04em; }

.scroll { overflow-x: auto; margin: 0 0 2.75rem; }
.scroll:focus-visible { outline: 2px solid var(--bar); outline-offset: 4px; }
table { width: 100%; border-collapse: collapse; font-size: .9rem; line-height: 1.45; }
caption { padding: 0 0 .8rem; text-align: left; color: var(--soft); max-width: 46rem; }
th, td { padding: .5rem 1.25rem .5rem 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--line); }
th:last-child, td:last-child { padding-right: 0; }
thead th { font-size: .8rem; font-weight: 550; color: var(--soft); line-height: 1.3;
  vertical-align: bottom; }
tbody th { font-weight: 550; white-space: nowrap; }
.number { text-align: right; }
td.number { white-space: nowrap; }
.nowrap { white-space: nowrap; }
.wide { min-width: 16rem; }
th small, td small { display: block; font-weight: 400; }
.muted, .muted th { color: var(--soft); font-weight: 400; }
small { font-size: .9em; color: var(--soft); }
code { font: .92em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
.break { display: block; min-width: 12rem; overflow-wrap: anywhere; white-space: normal; }
.many th, .many td { padding-right: .7rem; }
.sheet { margin: 0; }
thead button { all: unset; cursor: pointer; }
thead button:focus-visible { outline: 2px solid var(--bar); outline-offset: 3px; }
thead button:hover { color: var(--ink); }
[aria-sort=ascending] button::after { content: " \2191"; }
[aria-sort=descending] button::after { content: " \2193"; }
.verdict { white-space: nowrap; }
.verdict::before { content: ""; display: inline-block; width: .5em; height: .5em;
  margin-right: .5em; border-radius: 50%; background: var(--good); vertical-align: .08em; }
.doubtful::before, .ambiguous::before { background: var(--warn); }
.rejected::before { background: var(--bad); }
.bar { display: block; min-width: 8rem; height: .55rem; margin-top: .45rem; }
.bar span { display: block; height: 100%; min-width: 1px; border-radius: .15rem;
  background: var(--bar); }
footer { margin-top: 4.5rem; padding-top: 1.25rem; border-top: 1px solid var(--line);
  font-size: .85rem; color: var(--soft); }

@media (max-width: 40rem) {
  body { padding: 2.25rem 1.1rem 3rem; }
  h1 { font-size: 1.75rem; }
  h2 { margin-top: 3.25rem; }
  .figures { display: grid; grid-template-columns: 1fr 1fr; gap: 1.25rem 1.25rem; margin-top: 2rem; }
  .figures dd { font-size: 1.35rem; }
  .plot { max-width: none; }
  .frame { margin-left: 1.7rem; }
  .tick { font-size: .65rem; }
  .legend { margin-left: 0; gap: .3rem 1rem; }
  .elevations figure { overflow-x: auto; }
  .elevation { max-width: none; }
  .drawing { max-width: none; height: auto; min-width: 44rem; }
  caption { position: sticky; left: 0; max-width: calc(100vw - 2.2rem); }
  .tag { font-size: .68rem; padding: 0 .35rem; }
  .station { width: 1.15rem; height: 1.15rem; font-size: .6rem; line-height: .9rem; }
}
@media print {
  :root {
    color-scheme: light;
    --page: #fff; --panel: #f6f6f3; --ink: #111; --soft: #555; --line: #ccc; --halo: #fff;
    --good: #2b7a4b; --warn: #a15c00; --bad: #b3342b; --bar: #8fa7b8;
  }
  @page { margin: 16mm 14mm; }
  body { padding: 0; max-width: none; font-size: 10pt; }
  h2 { margin-top: 2rem; break-after: avoid; }
  figcaption, caption, .note { break-after: avoid; }
  #viewer, figure, tr, .checks, .figures { break-inside: avoid; }
  .figures { margin-top: 1.5rem; gap: 1rem .8rem; }
  .figures dd { font-size: 1.1rem; }
  figure { margin-bottom: 1.5rem; }
  .scroll { overflow: visible; margin-bottom: 1.5rem; }
  .plot { max-width: calc(var(--aspect) * 23rem); }
  .stages { grid-template-columns: 1fr 1fr; gap: 0 1rem; }
  .drawing { max-height: 21cm; width: auto; }
  .elevations figure { margin-bottom: 1rem; }
  table { font-size: 7.5pt; }
  th, td { padding: .3rem .45rem .3rem 0; }
  thead th { font-size: 7pt; }
  thead button::after { content: none; }
  .wide { min-width: 11rem; }
  code { overflow-wrap: anywhere; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";

constexpr std::string_view script = R"js(
for (const table of document.querySelectorAll("table")) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
      const key = (row) => row.cells[column].dataset.sort ?? row.cells[column].textContent;
      const compare = (a, b) => key(a).localeCompare(key(b), "en", { numeric: true });
      const numbers = (a, b) => Number(key(a)) - Number(key(b));
      const rows = [...table.tBodies[0].rows];
      const known = rows.filter((row) => key(row) !== "\u2013");
      const absent = rows.filter((row) => key(row) === "\u2013");
      const order = known.every((row) => !Number.isNaN(Number(key(row)))) ? numbers : compare;
      known.sort((a, b) => sign * order(a, b));
      table.tBodies[0].append(...known, ...absent);
    });
  });
}
)js";

}  // namespace

std::string report_style() {
    std::string style(rules);
    for (std::size_t id = 0; id < num_labels; ++id) {
        const auto label = static_cast<Label>(id);
        const auto [red, green, blue] = label_color(label);
        style += fmt::format(
            ".label-{0} {{ stroke: rgb({1} {2} {3}); background: rgb({1} {2} {3}); }}\n",
            label_name(label), red, green, blue);
    }
    return style;
}

std::string_view report_script() {
    return script;
}

}  // namespace roomscribe
