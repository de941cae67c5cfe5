// Elements, numbers as text, tables: what the sections and figures are made of.

const DARK = matchMedia("screen and (prefers-color-scheme: dark)");
// Okabe-Ito without its yellow (too pale on white), then four dark colours for pumps with many pistons; the same
// in report/picture/elements.h. On a dark ground the dark ones are lighter.
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000",
                 "#7f3b08", "#542788", "#5f6b75"];
const EXTRA_COLOURS = ["#444c55", "#8a5a00", "#7a3b8f"];
// Of arrows in space: the first eight differ most, for the colour-blind too.
const SCENE_COLOURS = ["#0072b2", "#e69f00", "#000000", "#009e73", "#56b4e9", "#d55e00", "#cc79a7", "#542788",
                       "#7f3b08", "#5f6b75", "#8a5a00", "#7a3b8f", "#444c55"];
const LIGHTER = { "#0072b2": "#3d9fdc", "#d55e00": "#f5822a", "#009e73": "#1fc498", "#000000": "#f2f4f6", "#7f3b08": "#c98a5c",
                  "#542788": "#a98be0", "#5f6b75": "#98a4af", "#444c55": "#b4bec8", "#8a5a00": "#d0a04a", "#7a3b8f": "#c58ad8" };
const onGround = colour => (DARK.matches && LIGHTER[colour]) || colour;
const variable = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const DASHES = [null, [8, 5], [2, 4]];  // by table; the first is solid
const DASH = "\u2013";                  // stands for "not computed", never for zero
const GOOD = ["agrees", "holds", "explained", "inside"];
const BAD = ["incomplete", "differs", "violated", "exceeded", "too low", "unexplained", "not explained", "outside"];

// Light to dark, as report/picture/elements.cpp has it; t from 0 to 1.
const SHADES = [[247, 250, 252], [190, 214, 235], [107, 164, 207], [33, 103, 166], [8, 40, 88]];
function shade(t) {
  const at = Math.min(1, Math.max(0, t)) * (SHADES.length - 1), k = Math.min(Math.floor(at), SHADES.length - 2);
  return `rgb(${SHADES[k].map((v, i) => Math.round(v + (at - k) * (SHADES[k + 1][i] - v))).join(" ")})`;
}

// ---- Elements

// Browsers may break a line inside 2.1e-14; such numbers are kept whole.
const unbroken = text => text.split(/(\d[\d.]*e-\d+)/).map((part, i) => {
  if (i % 2 === 0) return part;
  const span = document.createElement("span");
  span.className = "whole";
  span.textContent = part;
  return span;
});

// el("p.note", {title: "..."}, children...): strings become text nodes, null children are skipped.
function el(spec, attributes, ...children) {
  const [tag, ...classes] = spec.split(".");
  const node = document.createElement(tag);
  if (classes.length) node.className = classes.join(" ");
  for (const [name, value] of Object.entries(attributes || {}))
    if (value != null && value !== false) node.setAttribute(name, value === true ? "" : value);
  for (const child of children.flat(2))
    if (child != null) node.append(...(child instanceof Node ? [child] : unbroken(String(child))));
  return node;
}

function svg(tag, attributes, text) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text != null) node.textContent = text;
  return node;
}

// Draws a box once, when it is near the screen, one in a frame: a reader of thousands of samples waits neither for
// curves far below nor for those passed by.
let watched = null;
function startDrawing() {
  if (watched) watched.stop();
  const draws = new Map(), near = new Set();
  const drawNow = box => {
    const draw = draws.get(box);
    near.delete(box);
    draws.delete(box);
    watcher.unobserve(box);
    draw();
  };
  const next = () => {
    const [box] = near;
    if (!box) return;
    drawNow(box);
    requestAnimationFrame(next);
  };
  const watcher = new IntersectionObserver(entries => {
    const idle = near.size === 0;
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting && draws.has(target)) near.add(target);
      else near.delete(target);
    }
    if (idle) requestAnimationFrame(next);
  }, { rootMargin: "900px 0px" });
  watched = { draws, watcher, drawAll: () => [...draws.keys()].forEach(drawNow), stop: () => { near.clear(); watcher.disconnect(); } };
}
addEventListener("beforeprint", () => watched && watched.drawAll());  // whatever a reader prints of them
function whenNear(box, draw) {
  watched.draws.set(box, draw);
  watched.watcher.observe(box);
}

const list = value => (Array.isArray(value) ? value : []);
const phrases = (...parts) => parts.filter(Boolean).join(", ");
const chip = word => {
  const tone = GOOD.includes(word) ? "good" : BAD.includes(word) ? "bad" : "neutral";
  return el("span.chip." + tone, {}, word || DASH);
};

// Names and values of a short list of facts: [["compiler", "..."], ...].
const facts = (pairs, style = "") => !list(pairs).length ? null :
  el("dl.facts" + style, {}, pairs.map(([name, value]) =>
    el("div", {}, el("dt", {}, String(name)), el("dd", {}, value instanceof Node ? value : number(value)))));

// ---- Numbers

const scientific = (v, digits) =>
  v.toExponential(digits - 1).replace(/\.?0*e\+?/, "e");  // 2.10e+3 -> 2.1e3

function number(v, digits = 5) {
  if (v == null || v === "") return DASH;
  if (typeof v !== "number") return String(v);
  const size = Math.abs(v);
  if (size === 0) return "0";
  if (size < 1e-3 || size >= 1e7) return scientific(v, digits);
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return String(Number(v.toFixed(decimals)));
}

// Differences are known to their order of magnitude only: more digits would be noise.
const small = v => typeof v === "number" && Math.abs(v) < 1e-3 ? number(v, 2) : number(v, 3);
// A ratio reads as per cent where per cent is a natural size.
const ratio = v => typeof v === "number" && Math.abs(v) >= 1e-5 ? number(100 * v, 3) + " %" : small(v);
const unit = (text, name) => (text === DASH || !name ? text : text + "\u00a0" + name);
const degrees = v => unit(typeof v === "number" ? number(Number(v.toFixed(3)), 6) : DASH, "deg");

// ---- Tables

const tableCell = (tag, head, ...content) =>
  el(tag, { role: "cell", "data-head": head }, el("div", {}, ...content));

// columns: {head, cell: row -> text or node, num: right-aligned, main: names the row}. Every cell carries
// its heading, because on a narrow page the style sheet shows each row of a table that folds, one of texts, as a block
// of "heading: value" (then the roles keep it a table for a screen reader). One of numbers keeps its columns and scrolls
// below its first one.
function table(columns, rows, { rowClass, fold = true, style = "" } = {}) {
  const head = el("tr", { role: "row" }, columns.map(c =>
    el(c.num ? "th.num" : "th", { scope: "col", role: "columnheader" }, c.head)));
  const body = rows.map(row => el("tr", { role: "row", class: rowClass && rowClass(row) || null }, columns.map(c => {
    const style = c.num ? ".num" : "";
    return c.main ? el("th" + style, { scope: "row", role: "rowheader" }, c.cell(row))
                  : tableCell("td" + style, c.head, c.cell(row));
  })));
  return el("div.scroll", {}, el("table" + style + (fold ? ".fold" : ".wide"), { role: "table" },
    el("thead", { role: "rowgroup" }, head), el("tbody", { role: "rowgroup" }, body)));
}
