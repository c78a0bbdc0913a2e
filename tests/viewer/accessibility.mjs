// SPDX-License-Identifier: MIT
// What a page is to somebody who does not see it, or has no mouse: Chromium's accessibility tree, the way of the
// Tab key, and the contrast of words. Gives a list of complaints.

const controls = new Set(["button", "link", "checkbox", "radio", "slider", "combobox", "listbox", "spinbutton", "switch", "tab", "textbox"]);
/// What may take the focus without being a control: a box that scrolls, and the picture that keys steer.
const steered = new Set(["group", "region", "application"]);

const roleOf = (node) => node.role?.value ?? "";
const nameOf = (node) => (node.name?.value ?? "").trim();
const has = (node, property) => node.properties?.some(({ name, value }) => name === property && value.value);

async function checkTree(page) {
  const session = await page.createCDPSession();
  const { nodes } = await session.send("Accessibility.getFullAXTree");
  await session.detach();
  const complaints = [];
  const byId = new Map(nodes.map((node) => [node.nodeId, node]));
  const shown = nodes.filter((node) => !node.ignored);
  const below = function* (node) {
    for (const id of node.childIds ?? []) {
      const child = byId.get(id);
      if (!child) continue;
      yield child;
      yield* below(child);
    }
  };
  let level = 0;
  for (const node of shown) {
    const role = roleOf(node);
    if (controls.has(role) && !nameOf(node)) complaints.push(`a ${role} has no name`);
    if (has(node, "focusable") && role !== "RootWebArea" && !controls.has(role)) {
      // Options are told by the list that holds them.
      if (!steered.has(role) && !["option", "MenuListOption", "menuitem"].includes(role)) complaints.push(`what is a ${role} takes the focus: ${nameOf(node)}`);
      else if (!nameOf(node)) complaints.push(`a ${role} takes the focus and has no name`);
    }
    if (["image", "img", "graphics-document"].includes(role) && nameOf(node).length < 4) complaints.push("a picture has no words: " + nameOf(node));
    if (role === "group" && !nameOf(node)) complaints.push("a group has no name");
    if (role === "table") {
      const cells = new Set([...below(node)].map(roleOf));
      if (!nameOf(node)) complaints.push("a table has no caption");
      for (const head of ["columnheader", "rowheader"]) if (!cells.has(head)) complaints.push(`the table "${nameOf(node)}" has no ${head}`);
    }
    if (role === "heading") {
      const next = node.properties.find(({ name }) => name === "level").value.value;
      if (next > level + 1) complaints.push(`the heading "${nameOf(node)}" skips a level`);
      level = next;
    }
  }
  for (const landmark of ["main", "banner", "contentinfo"]) if (!shown.some((node) => roleOf(node) === landmark)) complaints.push("there is no " + landmark);
  const counts = {};
  for (const node of shown) counts[roleOf(node)] = (counts[roleOf(node)] ?? 0) + 1;
  return { complaints, counts };
}

/// From the first element to the last by Tab: every one that should be is reached, in the order of the page, and its
/// focus is seen.
async function checkTabs(page) {
  const wanted = await page.evaluate(() => {
    const isShown = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility !== "hidden";
    const all = [...document.querySelectorAll("a[href], button, input, select, textarea, [tabindex]")].filter((element) => isShown(element) && element.tabIndex >= 0 && !element.disabled);
    // Of a set of radio buttons Tab meets the chosen one.
    const met = all.filter((element) => element.type !== "radio" || element.checked);
    met.forEach((element, i) => { element.dataset.tabOrder = i; });
    document.activeElement?.blur();
    window.getSelection().removeAllRanges();
    window.scrollTo(0, 0);
    return met.length;
  });
  const complaints = [];
  await page.evaluate("document.body.tabIndex = -1; document.body.focus(); document.body.removeAttribute('tabindex')");
  for (let i = 0; i < wanted; ++i) {
    await page.keyboard.press("Tab");
    const met = await page.evaluate(() => {
      const element = document.activeElement;
      const marks = (style) => (style.outlineStyle !== "none" && parseFloat(style.outlineWidth) > 0) || style.boxShadow !== "none";
      const near = [element, element.nextElementSibling, element.parentElement].filter(Boolean);
      const isSeen = marks(getComputedStyle(element)) || near.some((one) => marks(getComputedStyle(one, "::after"))) ||
        (element.nextElementSibling !== null && marks(getComputedStyle(element.nextElementSibling)));
      const words = `${element.tagName.toLowerCase()} "${(element.getAttribute("aria-label") ?? element.textContent).trim().slice(0, 40)}"`;
      return { order: Number(element.dataset.tabOrder ?? -1), isSeen, words };
    });
    if (met.order !== i) {
      complaints.push(`Tab leads to ${met.words}, number ${met.order} instead of ${i} of ${wanted}`);
      break;
    }
    if (!met.isSeen) complaints.push(`the focus of ${met.words} is not seen`);
  }
  await page.keyboard.press("Tab");
  if (await page.evaluate("document.activeElement.dataset.tabOrder !== undefined && Number(document.activeElement.dataset.tabOrder) !== 0")) complaints.push("Tab does not leave the last element");
  return { complaints, wanted };
}

/// Words against what is behind them: 4.5 : 1, or 3 : 1 of large ones (WCAG 2.2, 1.4.3).
export async function checkContrast(page) {
  return page.evaluate(() => {
    const context = Object.assign(document.createElement("canvas"), { width: 1, height: 1 }).getContext("2d", { willReadFrequently: true });
    const rgba = (color) => {
      context.clearRect(0, 0, 1, 1);
      context.fillStyle = color;
      context.fillRect(0, 0, 1, 1);
      return [...context.getImageData(0, 0, 1, 1).data];
    };
    const light = (c) => [0.2126, 0.7152, 0.0722].reduce((sum, weight, i) => {
      const share = c[i] / 255;
      return sum + weight * (share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4);
    }, 0);
    const behind = (element) => {
      const layers = [];
      for (let at = element; at; at = at.parentElement) {
        const layer = rgba(getComputedStyle(at).backgroundColor);
        if (layer[3] > 0) layers.push(layer);
        if (layer[3] === 255) break;
      }
      return layers.reverse().reduce((below, [r, g, b, a]) => [r, g, b].map((value, i) => value * a / 255 + below[i] * (1 - a / 255)), [255, 255, 255]);
    };
    const complaints = new Set();
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const element = walker.currentNode.parentElement;
      if (!walker.currentNode.data.trim() || element.closest("script, style, svg, option, [hidden], [aria-hidden=true]") || element.getClientRects().length === 0) continue;
      const style = getComputedStyle(element);
      const size = parseFloat(style.fontSize);
      const isLarge = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
      const [a, b] = [light(rgba(style.color)), light(behind(element))];
      const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      if (contrast < (isLarge ? 3 : 4.5)) complaints.add(`"${walker.currentNode.data.trim().slice(0, 30)}" has a contrast of ${contrast.toFixed(1)}`);
    }
    return [...complaints];
  });
}

export async function checkAccessibility(page) {
  const page_ = await page.evaluate(() => ({ lang: document.documentElement.lang, title: document.title, bare: document.querySelectorAll("img:not([alt])").length,
    drawings: [...document.querySelectorAll("svg")].filter((svg) => !svg.closest("[aria-hidden=true]") && !(svg.getAttribute("role") === "img" && svg.getAttribute("aria-label"))).length }));
  const complaints = [];
  if (!page_.lang) complaints.push("the language is not said");
  if (!page_.title) complaints.push("the page has no title");
  if (page_.bare) complaints.push(`${page_.bare} pictures have no alternative`);
  if (page_.drawings) complaints.push(`${page_.drawings} drawings have no name`);
  const tree = await checkTree(page);
  const tabs = await checkTabs(page);
  return { complaints: [...complaints, ...tree.complaints, ...tabs.complaints, ...await checkContrast(page)], counts: tree.counts, tabs: tabs.wanted };
}
