// Draws the comparison report from the two JSON blocks of the page. Knows no physics and no channel
// names: every name, unit and number comes from the data. Text goes in by textContent only, so nothing
// in a case file can become markup.
(() => {
"use strict";

// Okabe-Ito without its yellow (too pale on white), then four dark colours for pumps with many pistons.
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000",
                 "#7f3b08", "#542788", "#5f6b75"];
const EXTRA_COLOURS = ["#444c55", "#8a5a00", "#7a3b8f"];
const DASHES = [null, [8, 5], [2, 4]];  // by table; the first is solid
const DASH = "\u2013";                  // stands for "not computed", never for zero
const GOOD = ["agrees", "holds", "explained", "inside"];
const BAD = ["differs", "violated", "unexplained", "not explained", "outside"];

// ---- Elements ----------------------------------------------------------------------------------

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

// ---- Numbers -----------------------------------------------------------------------------------

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

// ---- Tables ------------------------------------------------------------------------------------

const tableCell = (tag, head, ...content) =>
  el(tag, { role: "cell", "data-head": head }, el("div", {}, ...content));

// columns: {head, cell: row -> text or node, num: right-aligned, main: names the row}. Every cell carries
// its heading, because on a narrow page the style sheet shows each row as a block of "heading: value"
// (then the roles keep it a table for a screen reader).
function table(columns, rows, { rowClass, fold = true, style = "" } = {}) {
  const head = el("tr", { role: "row" }, columns.map(c =>
    el(c.num ? "th.num" : "th", { scope: "col", role: "columnheader" }, c.head)));
  const body = rows.map(row => el("tr", { role: "row", class: rowClass && rowClass(row) || null }, columns.map(c => {
    const style = c.num ? ".num" : "";
    return c.main ? el("th" + style, { scope: "row", role: "rowheader" }, c.cell(row))
                  : tableCell("td" + style, c.head, c.cell(row));
  })));
  return el("div.scroll", {}, el("table" + style + (fold ? ".fold" : ""), { role: "table" },
    el("thead", { role: "rowgroup" }, head), el("tbody", { role: "rowgroup" }, body)));
}

// ---- Sections above the figures ----------------------------------------------------------------

function verdictBanner({ verdict, meaning }, data) {
  if (!verdict && !meaning) return null;
  const tiles = [];
  if (verdict) {
    const worst = verdict.worst || {};
    if (verdict.compared != null) tiles.push(["channels compared", verdict.compared]);
    if (worst.max_over_peak != null) tiles.push(["worst difference", ratio(worst.max_over_peak) + " of peak"]);
    if (worst.channel) tiles.push(["found in", el("span", {}, el("code", {}, worst.channel),
      worst.theta_deg == null ? null : " at " + degrees(worst.theta_deg))]);
    if (verdict.rest_over_peak != null) {  // unequal assumptions: the rest is what is judged
      tiles.push(["left unexplained", ratio(verdict.rest_over_peak) + " of peak"]);
      tiles.push(["tolerance of the rest", small(verdict.rest_tolerance) + " of peak"]);
    } else {
      if (verdict.tolerance != null) tiles.push(["tolerance", small(verdict.tolerance) + " of peak"]);
      if (verdict.digits != null) tiles.push(["digits in common", verdict.digits.toFixed(1)]);
    }
  }
  const tone = !verdict || verdict.agrees == null ? "neutral" : verdict.agrees ? "good" : "bad";
  return el("div", {},
    el("div.banner." + tone, { role: "status" },
      el("p.word", {}, verdict && verdict.word || { good: "Agrees", bad: "Differs", neutral: "No verdict" }[tone]),
      el("p.headline", {}, verdict && verdict.headline || "No comparison was made."),
      facts(tiles, ".tiles")),
    meaning ? el("p.meaning", {}, meaning) : null);
}

// What a report has to say in words: {text, groups: [{title, lines}]}.
const summary = ({ summary }) => !summary ? null : el("div", {},
  summary.text ? el("p", {}, summary.text) : null,
  list(summary.groups).map(g => el("div.block", {}, g.title ? el("h3", {}, g.title) : null,
    el("ul.plain", {}, list(g.lines).map(line => el("li", {}, line))))));

const warnings = ({ warnings }) => !list(warnings).length ? null :
  el("ul.warnings", {}, warnings.map(w => el("li", {}, el("strong", {}, w.name), el("span", {}, w.text))));

const commonInputs = ({ common }) => !list(common).length ? null : table([
  { head: "Input", main: true, cell: r => r.input },
  { head: "How both models get it", cell: r => r.value },
  { head: "What would catch an error in it", cell: r => r.caught_by || DASH },
], common);

const validity = ({ validity }) => !list(validity).length ? null : table([
  { head: "Limit", main: true, cell: r => r.limit },
  { head: "State", cell: r => chip(r.violated == null ? "not computed" : r.violated ? "violated" : "holds") },
  { head: "Share of the turn", num: true, cell: r => unit(number(r.share_percent, 3), "%") },
  { head: "Worst value", num: true, cell: r => unit(number(r.worst), r.unit) },
  { head: "at", num: true, cell: r => degrees(r.theta_deg) },
  { head: "Consequence", cell: r => r.consequence || DASH },
], validity, { rowClass: r => (r.violated ? "flag" : "") });

function assumptionSplit({ assumptions }, data) {
  if (!assumptions || !list(assumptions.rows).length && !list(assumptions.channels).length) return null;
  const share = (c, channel) => el("li", {}, el("b", {}, c.assumption), ": " + unit(small(c.max_abs), channel.unit)
    + ` (${ratio(c.over_peak)} of peak)` + (c.mean == null ? "" : ", mean " + unit(small(c.mean), channel.unit)));
  return el("div", {},
    assumptions.text ? el("p", {}, assumptions.text) : null,
    !list(assumptions.rows).length ? null : table([
      { head: "Assumption", main: true, cell: r => r.name },
      ...data.pair.map((name, i) => ({ head: name, cell: r => number(data.ofTable(r, i)) })),
      { head: "Equal", cell: r => (data.ofTable(r, 0) === data.ofTable(r, 1) ? "yes" : el("span.chip.warn", {}, "no")) },
    ], assumptions.rows),
    !list(assumptions.channels).length ? null : el("div", {},
      el("p.hint", {}, "The channel of each reaction with the largest difference:"),
      splitTable(worstOfGroups(assumptions.channels)),
      el("details.others", {}, el("summary", {}, `All channels (${assumptions.channels.length})`),
        splitTable(assumptions.channels))));

  function splitTable(channels) {
    return table([
      { head: "Channel", main: true, cell: r => el("code", {}, r.name) },
      { head: "Peak", num: true, cell: r => unit(number(r.peak), r.unit) },
      { head: "Largest difference", num: true, cell: r => unit(small(r.max_abs), r.unit) },
      { head: "of peak", num: true, cell: r => ratio(r.over_peak) },
      { head: "Made up of", cell: r => list(r.contributions).length
          ? el("ul.plain", {}, r.contributions.map(c => share(c, r))) : DASH },
      { head: "Rest", num: true, cell: r => el("span", {}, unit(small(r.rest), r.unit),
          r.rest_over_peak == null ? null : el("small", {}, ratio(r.rest_over_peak) + " of peak")) },
      { head: "Verdict", cell: r => chip(r.verdict) },
    ], channels);
  }
}

// The channel with the largest difference of each group, in the order of the groups.
function worstOfGroups(channels) {
  const worst = new Map();
  for (const channel of channels) {
    const key = channel.group + "|" + channel.kind;
    if (!worst.has(key) || channel.over_peak > worst.get(key).over_peak) worst.set(key, channel);
  }
  return [...worst.values()];
}

const runs = ({ runs }) => !list(runs).length ? null : el("div", {}, runs.map(run => el("div.block", {},
  el("h3", {}, run.title), run.text ? el("p", {}, run.text) : null, facts(run.facts),
  !run.table || !list(run.table.rows).length ? null : table(run.table.columns.map((head, i) => ({
    head, main: i === 0, num: run.table.rows.every(r => r[i] == null || typeof r[i] === "number"),
    cell: r => small(r[i]) })), run.table.rows, { fold: run.table.columns.length > 3, style: ".narrow" }))));

const published = ({ published }, data) => !published || !list(published.rows).length ? null : el("div", {},
  published.text ? el("p", {}, published.text) : null,
  table([
    { head: "Quantity", main: true, cell: r => r.quantity },
    ...(published.rows.some(r => r.at) ? [{ head: "At", cell: r => r.at || DASH }] : []),
    { head: "Paper", cell: r => number(r.paper) },
    ...data.pair.map((name, i) => ({ head: name, num: true, cell: r => unit(number(data.ofTable(r, i)), r.unit) })),
    { head: "Verdict", cell: r => chip(r.verdict) },
    { head: "Status", cell: r => r.status || DASH },
    { head: "Where", cell: r => r.where || DASH },
  ], published.rows));

const checks = ({ checks }) => !list(checks).length ? null : table([
  { head: "Check", main: true, cell: r => r.name },
  { head: "Model", cell: r => r.model },
  { head: "Verdict", cell: r => chip(r.verdict) },
  { head: "Worst", num: true, cell: r => unit(small(r.worst), r.unit) },
  { head: "Scale", num: true, cell: r => unit(number(r.scale), r.unit) },
  { head: "Relative", num: true, cell: r => small(r.relative) },
  { head: "Tolerance", num: true, cell: r => small(r.tolerance) },
  { head: "at", num: true, cell: r => degrees(r.theta_deg) },
], checks, { rowClass: r => (r.verdict === "violated" ? "flag" : "") });

// ---- Comparison table: a row per group of channels, which opens into its channels ----------------

// worst: +1 where large is bad, -1 where small is bad; the first click on a heading puts the worst on top.
const STATISTICS = [
  { key: "peak", head: "Peak", worst: 1, show: c => unit(number(c.peak), c.unit) },
  { key: "max_abs", head: "Largest difference", worst: 1, show: c => unit(small(c.max_abs), c.unit) },
  { key: "max_over_peak", head: "of peak", worst: 1, show: c => ratio(c.max_over_peak) },
  { key: "rms_over_peak", head: "RMS of peak", worst: 1, show: c => ratio(c.rms_over_peak) },
  { key: "theta_of_max_deg", head: "at", worst: 1, show: c => degrees(c.theta_of_max_deg) },
  { key: "digits", head: "Digits", worst: -1, show: c => (c.digits == null ? DASH : c.digits.toFixed(1)) },
];
const stateOf = c => (c.compared === false ? "not compared" : c.verdict);

// Order by one statistic (+1 largest first, -1 smallest first), what has no number last in both.
function byStatistic(items, key, direction) {
  const value = item => item[key] ?? -direction * Number.MAX_VALUE;
  return key ? [...items].sort((a, b) => direction * Math.sign(value(b) - value(a))) : items;
}

// Channels of one group; each statistic of the group is its worst channel's.
function groupChannels(channels) {
  const groups = new Map();
  for (const channel of channels) {
    const key = channel.group + "|" + channel.kind;
    if (!groups.has(key)) groups.set(key, { name: channel.group, channels: [] });
    groups.get(key).channels.push(channel);
  }
  return [...groups.values()].map(group => {
    const worst = byStatistic(group.channels, "max_over_peak", 1)[0];
    for (const { key, worst: sign } of STATISTICS) group[key] = byStatistic(group.channels, key, sign)[0][key];
    const states = group.channels.map(stateOf);
    const missing = states.filter(s => s === "not computed").length;
    return Object.assign(group, { worst, unit: worst.unit, meaning: worst.meaning,
      theta_of_max_deg: worst.theta_of_max_deg,
      state: ["differs", "explained"].find(s => states.includes(s)) || states.find(s => s !== "not computed") ||
        "not computed",
      missing: missing < states.length ? missing : 0 });
  });
}

// The second line of a channel: what acts on what, and the statistics that have no column.
function channelDetails(c, data) {
  const both = (values, digits) => list(values).map(v => number(v, digits)).join(" / ");
  const unless = (missing, text) => (missing ? "" : text);
  return facts([
    ["acts", phrases(c.on_body && "on " + c.on_body, c.by_body && "by " + c.by_body, c.point && "at " + c.point)],
    ["meaning", c.meaning],
    ["frame", phrases(c.frame, c.axis && "axis " + c.axis)],
    ["equation", c.equation],
    ["RMS difference", unless(c.rms == null, unit(small(c.rms), c.unit))],
    ["tolerance", unless(c.tolerance == null, small(c.tolerance) + " of peak")],
    [`mean (${data.pair.join(" / ")})`, unless(list(c.mean).every(m => m == null), unit(both(c.mean), c.unit))],
    ["difference of means", unless(c.mean_difference == null, unit(small(c.mean_difference), c.unit))],
    ...list(c.orders).map(o => ["order " + o.order,
      unit(both(o.amplitude), c.unit) + ", phase " + unit(both(o.phase_deg, 4), "deg")]),
  ].filter(([, value]) => value), ".inline");
}

function comparisonTable(channels, data, title) {
  const groups = groupChannels(channels);
  const differs = groups.some(g => g.state === "differs");
  const order = differs ? { key: "max_over_peak", direction: 1 } : { key: null, direction: 1 };
  const headings = [{ key: null, head: title }, { head: "Verdict" }, ...STATISTICS];

  const statisticCells = item => STATISTICS.map(s => tableCell("td.num", s.head, s.show(item)));
  const channelRows = group => byStatistic(group.channels, order.key, order.direction).flatMap(c => [
    el("tr.channel", { role: "row" }, el("th", { scope: "row", role: "rowheader" }, el("code", {}, c.name)),
      tableCell("td", "Verdict", chip(stateOf(c))), statisticCells(c)),
    el("tr.details", { role: "row" },
      el("td", { role: "cell", colspan: headings.length }, channelDetails(c, data)))]);

  // The channels of a closed group are not built: a pump may have hundreds.
  function setOpen(group, open) {
    group.open = open;
    group.button.setAttribute("aria-expanded", open);
    group.body.replaceChildren(...(open ? channelRows(group) : []));
  }
  for (const group of groups) {
    const n = group.channels.length;
    group.button = el("button.expand", { type: "button", "aria-expanded": "false" }, group.name || DASH);
    group.button.addEventListener("click", () => setOpen(group, !group.open));
    group.head = el("tbody.group", { role: "rowgroup" }, el("tr", { role: "row" },
      el("th", { scope: "rowgroup", role: "rowheader" }, group.button, el("span.meaning-of", {}, group.meaning || ""),
        el("small", {}, n === 1 ? "1 channel" : n + " channels",
          n > 1 && group.max_over_peak != null ? [", worst ", el("code", {}, group.worst.name)] : null)),
      tableCell("td", "Verdict", chip(group.state),
        group.missing ? el("small", {}, group.missing + " not computed") : null),
      statisticCells(group)));
    group.body = el("tbody", { role: "rowgroup" });
  }

  const cells = headings.map(h => {
    const cell = el(h.worst ? "th.num" : "th", { scope: "col", role: "columnheader" });
    if (h.key === undefined) return cell.append(h.head), cell;
    const button = el("button.sort", { type: "button",
      title: h.key ? "Sort by this column, worst first; again to reverse" : "Back to the files' order" }, h.head);
    button.addEventListener("click", () => {
      order.direction = order.key === h.key ? -order.direction : h.worst || 1;
      order.key = h.key;
      arrange();
    });
    cell.append(button);
    return cell;
  });
  const grid = el("table.comparison.fold", { role: "table" },
    el("thead", { role: "rowgroup" }, el("tr", { role: "row" }, cells)));
  function arrange() {
    headings.forEach((h, i) => h.key && h.key === order.key
      ? cells[i].setAttribute("aria-sort", order.direction > 0 ? "descending" : "ascending")
      : cells[i].removeAttribute("aria-sort"));
    for (const group of byStatistic(groups, order.key, order.direction)) {
      grid.append(group.head, group.body);
      if (group.open) setOpen(group, true);
    }
  }
  arrange();
  const all = el("button.small", { type: "button" }, "Open all groups");
  all.addEventListener("click", () => {
    const open = !groups.every(g => g.open);
    groups.forEach(g => setOpen(g, open));
    all.textContent = open ? "Close all groups" : "Open all groups";
  });
  return el("div", {}, el("div.tools", {}, all), el("div.scroll", {}, grid));
}

function comparison({ channels }, data) {
  if (!list(channels).length) return null;
  const compared = channels.filter(c => c.compared !== false);
  const others = channels.filter(c => c.compared === false);
  return el("div", {},
    el("p.hint", {}, "One row per reaction, showing its worst channel. "
      + "Open a row for its channels; click a heading to sort."),
    compared.length ? comparisonTable(compared, data, "Reaction") : null,
    others.length ? el("details.others", {},
      el("summary", {}, `Columns that are not part of the verdict (${others.length})`),
      comparisonTable(others, data, "Quantity")) : null);
}

// ---- Sections below the figures ------------------------------------------------------------------

function caseTable(report) {
  const entries = list(report.case && report.case.entries);
  if (!entries.length) return null;
  const tables = [...new Set(entries.map(e => e.table || ""))];
  return el("div", {}, report.case.file ? el("p", {}, "Case file ", el("code", {}, report.case.file)) : null,
    el("div.columns", {}, tables.map(name => el("div.block", {}, el("h3", {}, name ? `[${name}]` : "top level"),
      facts(entries.filter(e => (e.table || "") === name).map(e => [e.key, el("span", {}, String(e.value),
        e.defaulted ? el("span.default", {}, "default") : null)]), ".rows")))));
}

const derived = ({ derived }) => !list(derived).length ? null : table([
  { head: "Quantity", main: true, cell: r => r.name },
  { head: "Symbol", cell: r => r.symbol || DASH },
  { head: "Value", num: true, cell: r => unit(number(r.value), r.unit) },
  { head: "From", cell: r => r.source || DASH },
], derived);

function models({ models }) {
  const time = m => (m.seconds == null ? [] : [["time", unit(number(m.seconds, 3), "s")]]);
  return !list(models).length ? null : el("div.cards", {}, models.map(m => el("div.block.card", {},
    el("h3", {}, m.name), facts([...list(m.facts), ...time(m)], ".pairs"),
    list(m.assumptions).length ? [el("h4", {}, "Assumptions"), facts(m.assumptions, ".pairs")] : null)));
}

const versions = ({ program }) => facts(program, ".pairs");

// ---- Figures: curves -----------------------------------------------------------------------------

const hasNumbers = values => list(values).some(v => typeof v === "number");

// Ticks of the shaft angle: fractions of a turn (45, 60, 90 ...) for a whole turn or more, finer when zoomed.
function angleTicks(low, high, pixels) {
  const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 45, 60, 90, 180, 360, 720, 1440, 3600, 7200, 36000];
  const room = Math.max(2, pixels / 52);
  const step = steps.find(s => (high - low) / s <= room && (high - low < 359 || s >= 45)) || (high - low) / 4;
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6 * step; ++i)
    ticks.push({ v: Math.min(i * step, high - 1e-9 * (high - low)),  // dygraphs drops a tick on the very end
                 label: number(Number((i * step).toFixed(6)), 6) });
  return ticks;
}

// Decimals follow from the spacing of the ticks: no two ticks read alike and no tick shows round-off.
function tickLabels(values) {
  const step = Math.abs(values[1] - values[0]) || 1;
  const largest = Math.max(...values.map(Math.abs));
  const digit = v => Math.floor(Math.log10(v) + 1e-9);
  const plain = largest >= 1e-2 && largest < 1e6;
  return values.map(v => Math.abs(v) < 1e-6 * step ? "0"
    : plain ? v.toFixed(Math.max(0, -digit(step)))
    : scientific(v, 1 + Math.max(0, digit(Math.abs(v) * (1 + 1e-12)) - digit(step))));
}

// At least two ticks within the axis: a low plot may have room for one only, which says nothing of the scale.
function valueTicks(low, high, pixels, options, graph) {
  let ticks = [];
  for (let finer = 1; finer <= 4; finer *= 2) {
    const denser = name => (name === "pixelsPerLabel" ? options(name) / finer : options(name));
    ticks = Dygraph.numericTicks(low, high, pixels, denser, graph);
    if (ticks.filter(t => t.v >= low && t.v <= high).length >= 2) break;
  }
  const labels = tickLabels(ticks.map(t => t.v));
  return ticks.map((t, i) => ({ v: t.v, label: labels[i] }));
}

function valueAxisTicks(low, high, pixels, options, graph) {
  return valueTicks(low, high, pixels, options, graph).filter(t => t.v >= low && t.v <= high);
}

// One dygraph. lines: {values, colour, width, dash, silent}; bands are filled behind the curves.
function plot(box, data, lines, bands, yLabel) {
  const names = lines.map((_, i) => String(i));
  const rows = data.order.map(i => [data.theta[i], ...lines.map(l => l.values[i] ?? null)]);
  // Empty rows at the whole turns: the axis then ends at 360 although the last sample does not.
  const nothing = lines.map(() => null);
  if (data.low < rows[0][0]) rows.unshift([data.low, ...nothing]);
  if (data.high > rows[rows.length - 1][0]) rows.push([data.high, ...nothing]);
  const series = {};
  lines.forEach((l, i) => {
    series[i] = { color: l.colour, strokeWidth: l.width, strokePattern: l.dash || null, pointSize: 2.5,
                  drawPoints: rows.length < 20 && !l.silent, highlightCircleSize: l.silent ? 0 : 4 };
  });
  // Without the touch handlers a finger on a plot still scrolls the page.
  const { touchstart, touchmove, touchend, ...mouse } = Dygraph.defaultInteractionModel;
  return new Dygraph(box, rows, {
    labels: ["theta", ...names], series, legend: "never", interactionModel: mouse,
    xlabel: data.axis.label, ylabel: yLabel, labelsDiv: el("div"),
    axes: { x: { ticker: data.axis.angle ? angleTicks : valueAxisTicks, axisLabelWidth: 44 },
            y: { ticker: valueTicks, axisLabelWidth: 74, pixelsPerLabel: 26 } },
    axisLabelFontSize: 13, xLabelHeight: 20, yLabelWidth: 22, rightGap: 22, yRangePad: 8,
    gridLineColor: "#e1e6ec", gridLineWidth: 1, axisLineColor: "#67727e",
    underlayCallback(canvas, area, graph) {
      for (const band of bands) {
        const [top, bottom] = [graph.toDomYCoord(band.high), graph.toDomYCoord(band.low)];
        canvas.fillStyle = "rgba(110, 125, 140, 0.13)";
        canvas.fillRect(area.x, top, area.w, bottom - top);
      }
      canvas.fillStyle = "#9aa5b1";
      canvas.fillRect(area.x, Math.round(graph.toDomYCoord(0)), area.w, 1);
    },
  });
}

// Both plots of a figure show the same angles, and hovering one marks and reads out the other.
function synchronise(graphs, firstRow, readOut) {
  graphs.forEach((graph, which) => {
    const others = graphs.filter((_, i) => i !== which);
    graph.updateOptions({
      highlightCallback: (event, x, points, row) => {
        others.forEach(g => g.setSelection(row));
        readOut(row - firstRow);
      },
      unhighlightCallback: () => {
        others.forEach(g => g.clearSelection());
        readOut(null);
      },
      zoomCallback: (low, high) => others.forEach(g => {
        const [from, to] = g.xAxisRange();
        if (!graph.isZoomed()) g.updateOptions({ dateWindow: null, valueRange: null });
        else if (from !== low || to !== high) g.updateOptions({ dateWindow: [low, high] });
      }),
    });
  });
}

// A piece of line for the legend.
function swatch(colour, width, dash) {
  const box = svg("svg", { width: 34, height: 10, "aria-hidden": "true", class: "swatch" });
  box.append(svg("line", { x1: 0, x2: 34, y1: 5, y2: 5, stroke: colour, "stroke-width": width,
                           "stroke-dasharray": dash ? dash.join(" ") : "none" }));
  return box;
}

// The first table is drawn wide and pale, the others thin and dashed over it: equal curves stay both visible.
function lineOf(values, colour, t, alone) {
  const pale = t === 0 && !alone;
  return { values, colour: colour + (pale ? "66" : ""), width: pale ? 4.5 : 1.9, dash: DASHES[t % DASHES.length] };
}

// A figure may bring its own axis and curves: {x: {label, angle, values}, series: [{label, values}]}. It is
// then drawn from these alone; `angle` says that the axis is one of shaft angles.
const withOwnAxis = (figure, data) => (!figure.x ? data : {
  ...data, tables: [], difference: {}, axis: { label: figure.x.label, angle: !!figure.x.angle },
  ...orderOf(list(figure.x.values), !!figure.x.angle) });

function curvesFigure(figure, page) {
  const data = withOwnAxis(figure, page);
  const drawn = [], missing = [], lines = [], differences = [];
  list(figure.channels).forEach((name, i) => {
    const colour = COLOURS[i % COLOURS.length];
    const columns = data.tables.map(t => (hasNumbers(t.columns[name]) ? t.columns[name] : null));
    columns.forEach((c, t) => c || missing.push(`${name} (${data.tables[t].name})`));
    const alone = columns.filter(Boolean).length < 2;
    columns.forEach((values, t) => values && lines.push(lineOf(values, colour, t, alone)));
    const difference = hasNumbers(data.difference[name]) ? data.difference[name] : null;
    if (difference) differences.push({ values: difference, colour, width: 1.5 });
    if (columns.some(Boolean)) drawn.push({ name, colour, columns, difference });
  });
  const extras = list(figure.extra).filter(e => hasNumbers(e.values)).map((e, i) => ({
    ...e, colour: EXTRA_COLOURS[i % EXTRA_COLOURS.length], width: 1.6, dash: [10, 4, 2, 4] }));
  list(figure.series).filter(e => hasNumbers(e.values)).forEach((e, i) => extras.push({
    ...e, colour: COLOURS[i % COLOURS.length], width: 1.9, dash: null }));
  const notes = [figure.note, missing.length ? "Not computed: " + missing.join(", ") + "." : null];
  const footer = () => notes.filter(Boolean).map(n => el("p.note", {}, n));
  if (!drawn.length && !extras.length)
    return [el("p.empty", {}, "There is nothing to draw: no model computed these channels."), ...footer()];

  const bands = list(figure.bands);
  const edges = bands.flatMap(b => [b.low, b.high]).map(v => (
    { values: data.theta.map(() => v), colour: "#6b7682", width: 1, dash: [3, 3], silent: true }));
  const readings = readOutTable(figure, drawn, extras, bands, data);
  const label = figure.unit ? ` (${figure.unit})` : "";
  const upper = el("div.plot", { role: "img", "aria-label": `${figure.title}: curves over ${data.axis.label}` });
  const exact = differences.length > 0 && differences.every(d => d.values.every(v => !v));
  const lower = differences.length && !exact
    ? el("div.plot.low", { role: "img", "aria-label": `${figure.title}: difference over the shaft angle` }) : null;
  if (exact) notes.push("The difference is exactly zero wherever both were computed.");
  if (data.order.length < 2) return [readings.node, ...footer()];  // one angle makes no curve
  data.mounts.push(() => {
    const graphs = [plot(upper, data, [...edges, ...lines, ...extras], bands, "value" + label)];
    if (lower) graphs.push(plot(lower, data, differences, [], "difference" + label));
    synchronise(graphs, data.low < data.theta[data.order[0]] ? 1 : 0, readings.show);
    graphs.forEach(g => data.redraws.push(() => g.resize()));
  });
  return [readings.node, upper,
    lower ? el("p.subplot", {}, `Difference: ${data.pair[1]} minus ${data.pair[0]}`) : null, lower, ...footer()];
}

// Legend and hover values in one table above the plots, so that it never covers a curve. While nothing is
// pointed at it shows the angle of the largest difference.
function readOutTable(figure, drawn, extras, bands, data) {
  const compared = drawn.filter(d => d.difference);
  let home = 0, largest = 0;
  data.order.forEach((i, row) => compared.forEach(d => {
    if (Math.abs(d.difference[i] ?? 0) > largest) { largest = Math.abs(d.difference[i] ?? 0); home = row; }
  }));
  const angle = el("span.angle");
  const heading = (...content) => el("th.num", { scope: "col" }, ...content);
  const name = (...content) => el("th", { scope: "row" }, ...content);
  const wide = () => el("td.num", { colspan: Math.max(1, data.tables.length + (compared.length ? 1 : 0)) });
  const rows = drawn.map(d => ({ ...d, cells: d.columns.map(() => el("td.num")),
                                 gap: compared.length ? el("td.num") : null }));
  const more = extras.map(e => ({ ...e, cell: wide() }));
  const bandRows = bands.map(b => {
    const cell = wide();
    cell.textContent = `${number(b.low)} to ${unit(number(b.high), figure.unit)}`;
    return el("tr", {}, name(el("span.band"), b.label), cell);
  });
  const node = el("div.scroll", {}, el("table.readout", {},
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, angle),
      data.tables.map((t, i) => heading(t.name, swatch("#444c55", i ? 1.8 : 2.6, DASHES[i % DASHES.length]))),
      compared.length ? heading("difference") : null)),
    el("tbody", {},
      rows.map(r => el("tr", {}, name(swatch(r.colour, 4), el("code", { title: data.meaning(r.name) }, r.name)),
        r.cells, r.gap)),
      more.map(e => el("tr", {}, name(swatch(e.colour, e.width, e.dash), e.label), e.cell)),
      bandRows)));
  function show(row) {
    const at = row == null ? home : Math.min(Math.max(row, 0), data.order.length - 1);
    const i = data.order[at];
    const why = row != null ? "" : largest > 0 ? " (largest difference)" : data.axis.angle ? " (first angle)" : "";
    angle.textContent = (data.axis.angle ? degrees(data.theta[i])
      : `${data.axis.label}: ${number(data.theta[i])}`) + why;
    const value = v => unit(number(v, 6), figure.unit);
    for (const r of rows) {
      r.columns.forEach((c, t) => { r.cells[t].textContent = value(c && c[i]); });
      if (r.gap) r.gap.textContent = unit(small(r.difference && r.difference[i]), figure.unit);
    }
    for (const e of more) e.cell.textContent = value(e.values[i]);
  }
  show(null);
  return { node, show };
}

// ---- Figures: each piston's share at one angle ---------------------------------------------------

const sum = values => (values.some(v => typeof v !== "number") ? null : values.reduce((a, b) => a + b, 0));

function barsFigure(figure, data) {
  const names = list(figure.channels);
  const tables = data.tables.filter(t => names.some(n => hasNumbers(t.columns[n])));
  if (!tables.length) return [el("p.empty", {}, "There is nothing to draw: no model computed these channels.")];
  // One scale for the whole turn: the bars can be compared from angle to angle.
  const every = tables.flatMap(t => names.flatMap(n => list(t.columns[n]).filter(v => typeof v === "number")));
  const low = every.reduce((a, b) => Math.min(a, b), 0), high = every.reduce((a, b) => Math.max(a, b), 0);

  const slider = el("input", { type: "range", min: 0, max: data.order.length - 1, "aria-label": "Shaft angle" });
  const nearest = angle => data.order.reduce((best, i, row) =>
    Math.abs(data.theta[i] - angle) < Math.abs(data.theta[data.order[best]] - angle) ? row : best, 0);
  // A button leads to the sample next to its angle and says which; angles outside the run have none.
  const inside = list(figure.angles).filter(angle => angle > data.theta[data.order[0]] - data.step
    && angle < data.theta[data.order[data.order.length - 1]] + data.step);
  const buttons = [...new Set(inside.map(nearest))].map(row => {
    const button = el("button.small", { type: "button" }, degrees(data.theta[data.order[row]]));
    button.addEventListener("click", () => { slider.value = row; update(); });
    return { button, row };
  });
  slider.value = buttons.length ? buttons[0].row : 0;
  const reading = el("output.angle"), total = el("p.total", { "aria-live": "polite" });
  const chart = el("div.bars"), numbers = el("div.numbers");
  const share = v => (Math.abs(v) < 1e-3 ? small : number)(v);
  const key = el("p.key", {}, tables.map((t, k) => el("span", {}, el(k ? "i.t1" : "i.t0"), t.name)));

  function update() {
    const row = Number(slider.value), i = data.order[row], angle = degrees(data.theta[i]);
    const groups = names.map(n => (
      { label: data.pistonOf(n), values: tables.map(t => list(t.columns[n])[i] ?? null) }));
    const sums = tables.map((_, k) => sum(groups.map(g => g.values[k])));
    reading.textContent = angle;
    slider.setAttribute("aria-valuetext", angle);
    buttons.forEach(b => b.button.setAttribute("aria-pressed", b.row === row));
    total.textContent = `Sum at ${angle}: `
      + tables.map((t, k) => `${t.name} ${unit(share(sums[k]), figure.unit)}`).join(", ");
    chart.replaceChildren(barChart(chart.clientWidth || 600, groups, [low, high], figure));
    numbers.replaceChildren(table([
      { head: "Piston", main: true, cell: g => g.label },
      ...tables.map((t, k) => ({ head: figure.unit ? `${t.name} (${figure.unit})` : t.name, num: true,
        cell: g => share(g.values[k]) })),
    ], [...groups, { label: "sum", values: sums, total: true }],
    { fold: false, rowClass: g => (g.total ? "total" : "") }));
  }
  slider.addEventListener("input", update);
  data.mounts.push(() => { update(); new ResizeObserver(update).observe(chart); });
  data.redraws.push(update);
  return [el("div.slide", {}, el("label", {}, "Shaft angle ", reading), slider, buttons.map(b => b.button)), total,
    el("div.split", {}, el("div", {}, key, chart), numbers), figure.note ? el("p.note", {}, figure.note) : null];
}

// Bars as SVG in the pixels of their box, so that text keeps its size at every width.
function barChart(width, groups, [low, high], figure) {
  const left = 74, right = width - 10, top = 12, bottom = 236, height = 280;
  const margin = 0.06 * (high - low || 1), from = low < 0 ? low - margin : 0, to = high + margin;
  const y = v => top + (bottom - top) * (to - v) / (to - from);
  const root = svg("svg", { width, height, role: "img",
                            "aria-label": figure.title + ", bars; the values are in the table" });
  const text = (x, y, content, more) =>
    root.append(svg("text", { x, y, "text-anchor": "middle", ...more }, content));

  const ticks = roundTicks(from, to, 8), labels = tickLabels(ticks);
  ticks.forEach((v, i) => {
    root.append(svg("line", { x1: left, x2: right, y1: y(v), y2: y(v), class: labels[i] === "0" ? "zero" : "grid" }));
    text(left - 8, y(v) + 4, labels[i], { "text-anchor": "end" });
  });
  const slot = (right - left) / groups.length;
  const every = Math.ceil(26 / slot);  // not every piston has room for its number when there are many
  groups.forEach((g, i) => {
    const start = left + (i + 0.14) * slot, bar = 0.72 * slot / g.values.length;
    g.values.forEach((v, k) => v != null && root.append(svg("rect", { class: k ? "t1" : "t0",
      x: start + k * bar + 1, width: Math.max(1, bar - 2), y: y(Math.max(v, 0)), height: Math.abs(y(v) - y(0)) })));
    if (i % every === 0) text(left + (i + 0.5) * slot, bottom + 18, g.label);
  });
  const middle = (top + bottom) / 2;
  text((left + right) / 2, height - 6, "piston", { class: "axis" });
  text(14, middle, figure.unit ? `share (${figure.unit})` : "share",
       { class: "axis", transform: `rotate(-90 14 ${middle})` });
  return root;
}

// ---- Figures: points in a plane --------------------------------------------------------------------

// figure: {x: {label, log}, y: {label, log}, series: [{name, style, line, emphasis, points: [{x, y, note}]}]}. Points
// that a logarithmic axis cannot show are left out; every point's note shows on hovering.
const MARKS = [
  (x, y) => ({ tag: "circle", cx: x, cy: y, r: 4.5 }),
  (x, y) => ({ tag: "path", d: `M${x - 4.5},${y - 4.5}h9v9h-9z` }),
  (x, y) => ({ tag: "path", d: `M${x},${y - 5.5}l5.2,9h-10.4z` }),
  (x, y) => ({ tag: "path", d: `M${x},${y - 6}l6,6l-6,6l-6,-6z` }),
  (x, y) => ({ tag: "path", d: `M${x},${y + 5.5}l5.2,-9h-10.4z` }),
];
function mark(i, x, y, colour) {
  const { tag, ...shape } = MARKS[i % MARKS.length](x, y);
  return svg(tag, { ...shape, fill: colour, stroke: "#ffffff", "stroke-width": 1 });
}

function scatterFigure(figure, data) {
  const drawable = (axis, v) => typeof v === "number" && (!axis.log || v > 0);
  const all = list(figure.series).map(s => ({ ...s,
    points: list(s.points).filter(p => drawable(figure.x, p.x) && drawable(figure.y, p.y)) })).filter(s => s.points.length);
  if (!all.length) return [el("p.empty", {}, "There is nothing to draw.")];
  let next = 0;
  for (const s of all) {
    s.index = s.emphasis ? -1 : s.style ?? next++;  // the same style for the same thing in every figure
    s.colour = s.emphasis ? "#67727e" : COLOURS[s.index % COLOURS.length];
  }
  const key = el("p.key.wrap", {}, all.map(s => {
    const box = svg("svg", { width: 34, height: 14, "aria-hidden": "true", class: "swatch" });
    if (s.line) box.append(svg("line", { x1: 0, x2: 34, y1: 7, y2: 7, stroke: s.colour, "stroke-width": s.emphasis ? 6 : 1.5,
                                         opacity: s.emphasis ? 0.35 : 1 }));
    if (!s.emphasis) box.append(mark(s.index, 17, 7, s.colour));
    return el("span", {}, box, s.name);
  }));
  const chart = el("div.bars");
  const draw = () => chart.replaceChildren(scatterChart(chart.clientWidth || 600, figure, all));
  data.mounts.push(() => { draw(); new ResizeObserver(draw).observe(chart); });
  data.redraws.push(draw);
  return [key, chart, figure.note ? el("p.note", {}, figure.note) : null];
}

// Ticks of an axis from `low` to `high`: powers of ten, thinned out, where it is logarithmic.
function axisTicks(axis, low, high, most) {
  if (!axis.log) {
    const ticks = roundTicks(low, high, most), labels = tickLabels(ticks);
    return ticks.map((v, i) => ({ at: v, label: labels[i] }));
  }
  const every = Math.max(1, Math.ceil((high - low) / most)), ticks = [];
  for (let p = Math.ceil(low / every) * every; p <= high; p += every) ticks.push({ at: p, label: "1e" + p });
  return ticks;
}

function scatterChart(width, figure, series) {
  const left = 74, right = width - 14, top = 12, bottom = 380, height = 430;
  const place = (axis, v) => (axis.log ? Math.log10(v) : v);
  const range = (axis, key) => {
    const values = series.flatMap(s => s.points.map(p => place(axis, p[key])));
    const low = Math.min(...values), high = Math.max(...values), margin = 0.04 * (high - low) || 0.5;
    return axis.log ? [Math.floor(low - 0.05), Math.ceil(high + 0.05)] : [low - margin, high + margin];
  };
  const [x0, x1] = range(figure.x, "x"), [y0, y1] = range(figure.y, "y");
  const px = v => left + (right - left) * (place(figure.x, v) - x0) / (x1 - x0);
  const py = v => bottom - (bottom - top) * (place(figure.y, v) - y0) / (y1 - y0);
  const root = svg("svg", { width, height, role: "img", "aria-label": figure.title + "; the values are in the table" });
  const text = (x, y, content, more) => root.append(svg("text", { x, y, "text-anchor": "middle", ...more }, content));
  for (const t of axisTicks(figure.x, x0, x1, Math.max(2, (right - left) / 70))) {
    const x = left + (right - left) * (t.at - x0) / (x1 - x0);
    root.append(svg("line", { x1: x, x2: x, y1: top, y2: bottom, class: "grid" }));
    text(x, bottom + 18, t.label);
  }
  for (const t of axisTicks(figure.y, y0, y1, 14)) {
    const y = bottom - (bottom - top) * (t.at - y0) / (y1 - y0);
    root.append(svg("line", { x1: left, x2: right, y1: y, y2: y, class: "grid" }));
    text(left - 8, y + 4, t.label, { "text-anchor": "end" });
  }
  // What is emphasised lies broad and pale under the rest.
  for (const s of [...series].sort((a, b) => (b.emphasis ? 1 : 0) - (a.emphasis ? 1 : 0))) {
    if (s.line && s.points.length > 1)
      root.append(svg("polyline", { points: s.points.map(p => `${px(p.x)},${py(p.y)}`).join(" "), fill: "none",
        stroke: s.colour, "stroke-width": s.emphasis ? 8 : 1.3, opacity: s.emphasis ? 0.35 : 1, "stroke-linejoin": "round" }));
    if (s.emphasis) continue;
    for (const p of s.points) {
      const dot = mark(s.index, px(p.x), py(p.y), s.colour);
      dot.append(svg("title", {}, phrases(p.note, `${figure.x.label} ${small(p.x)}`, `${figure.y.label} ${small(p.y)}`)));
      root.append(dot);
    }
  }
  text((left + right) / 2, height - 6, figure.x.label, { class: "axis" });
  text(14, (top + bottom) / 2, figure.y.label, { class: "axis", transform: `rotate(-90 14 ${(top + bottom) / 2})` });
  return root;
}

// Multiples of 1, 2 or 5 times a power of ten.
function roundTicks(low, high, most) {
  const power = 10 ** Math.floor(Math.log10((high - low) / most));
  const step = power * [1, 2, 5, 10].find(m => m * power * most >= high - low);
  const ticks = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) ticks.push(k * step);
  return ticks;
}

// ---- Figures: any quantity over any other, and maps over two -----------------------------------------

// One axis of a plot: {label, unit, log, from, to}. Place of a value between two pixels, and ticks.
function plotAxis(spec, values, first, last) {
  const log = Boolean(spec.log);
  const usable = values.filter(v => typeof v === "number" && (!log || v > 0));
  let low = spec.from ?? Math.min(...usable), high = spec.to ?? Math.max(...usable);
  if (!usable.length) [low, high] = log ? [0.1, 1] : [0, 1];
  if (low === high) [low, high] = log ? [low / 2, high * 2] : [low - 1, high + 1];
  const scale = log ? Math.log10 : v => v;
  const place = v => first + (last - first) * (scale(v) - scale(low)) / (scale(high) - scale(low));
  const name = spec.label + (spec.unit ? ` (${spec.unit})` : "");
  if (!log) {
    const ticks = roundTicks(low, high, 8), labels = tickLabels(ticks);
    return { place, name, low, high, log, ticks: ticks.map((v, i) => ({ v, label: labels[i] })) };
  }
  const decades = Math.log10(high / low);
  const digits = decades > 2 ? [1] : decades > 1 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 8];
  const every = Math.max(1, Math.ceil(decades / 8));
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
    for (const digit of power % every === 0 ? digits : []) {
      const v = Number((digit * 10 ** power).toPrecision(6));
      if (v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9)) ticks.push({ v, label: number(v, 3) });
    }
  return { place, name, low, high, log, ticks };
}

const plotText = (root, x, y, content, more) =>
  root.append(svg("text", { x, y, "text-anchor": "middle", ...more }, content));

function drawAxes(root, x, y, [left, right, top, bottom]) {
  for (const t of x.ticks) {
    root.append(svg("line", { x1: x.place(t.v), x2: x.place(t.v), y1: top, y2: bottom, class: "grid" }));
    plotText(root, x.place(t.v), bottom + 18, t.label);
  }
  for (const t of y.ticks) {
    root.append(svg("line", { x1: left, x2: right, y1: y.place(t.v), y2: y.place(t.v), class: "grid" }));
    plotText(root, left - 8, y.place(t.v) + 4, t.label, { "text-anchor": "end" });
  }
  plotText(root, (left + right) / 2, bottom + 38, x.name, { class: "axis" });
  const middle = (top + bottom) / 2;
  plotText(root, 14, middle, y.name, { class: "axis", transform: `rotate(-90 14 ${middle})` });
}

// A box whose drawing follows its width.
function drawnBox(figure, data, draw) {
  const box = el("div.bars");
  const redraw = () => box.replaceChildren(draw(box.clientWidth || 700));
  data.mounts.push(() => { redraw(); new ResizeObserver(redraw).observe(box); });
  data.redraws.push(redraw);
  return box;
}

// {x: axis, y: axis, series: [{label, x: [..], y: [..]}]}
function xyFigure(figure, data) {
  const all = list(figure.series).map((s, i) => ({ ...s, colour: COLOURS[i % COLOURS.length],
    dash: DASHES[Math.floor(i / COLOURS.length) % DASHES.length] }));
  const draw = width => {
    const area = [80, width - 24, 12, 316];
    const x = plotAxis(figure.x, all.flatMap(s => s.x), area[0], area[1]);
    const y = plotAxis(figure.y, all.flatMap(s => s.y), area[3], area[2]);
    const root = svg("svg", { width, height: 366, role: "img", "aria-label": figure.title + "; the values are in the tables" });
    drawAxes(root, x, y, area);
    for (const s of all) {
      const points = s.x.map((v, i) => [v, s.y[i]]).filter(([u, v]) => typeof u === "number" && typeof v === "number"
        && (!x.log || u > 0) && (!y.log || v > 0)).map(([u, v]) => [x.place(u), y.place(v)]);
      root.append(svg("polyline", { points: points.map(p => p.join(",")).join(" "), fill: "none", stroke: s.colour,
        "stroke-width": 1.9, "stroke-dasharray": s.dash ? s.dash.join(" ") : "none" }));
      if (points.length <= 60) points.forEach(([u, v], i) => {
        const dot = svg("circle", { cx: u, cy: v, r: 3, fill: s.colour });
        dot.append(svg("title", {}, `${s.label}: ${number(s.y[i])} at ${number(s.x[i])}`));
        root.append(dot);
      });
    }
    return root;
  };
  const key = el("p.key", {}, all.map(s => el("span", {}, swatch(s.colour, 3, s.dash), s.label)));
  return [key, drawnBox(figure, data, draw), figure.note ? el("p.note", {}, figure.note) : null];
}

// Pieces of the line z = level over a grid, by marching squares, in the plot's own coordinates.
// Where a corner has no value there is no line.
function contour(xs, ys, z, level) {
  const pieces = [];
  for (let i = 0; i + 1 < ys.length; ++i) for (let j = 0; j + 1 < xs.length; ++j) {
    const corners = [[j, i], [j + 1, i], [j + 1, i + 1], [j, i + 1]];
    if (corners.some(([a, b]) => typeof z[b][a] !== "number")) continue;
    const cuts = [];
    corners.forEach(([a, b], k) => {
      const [c, d] = corners[(k + 1) % 4], from = z[b][a], to = z[d][c];
      if ((from < level) === (to < level)) return;
      const t = (level - from) / (to - from);
      cuts.push([xs[a] + t * (xs[c] - xs[a]), ys[b] + t * (ys[d] - ys[b])]);
    });
    for (let k = 0; k + 1 < cuts.length; k += 2) pieces.push([cuts[k], cuts[k + 1]]);
  }
  return pieces;
}

// Light to dark by t in [0, 1]: the order of the values survives a print without colour.
const SHADES = [[247, 250, 252], [190, 214, 235], [107, 164, 207], [33, 103, 166], [8, 40, 88]];
function shade(t) {
  const at = Math.min(Math.max(t, 0), 1) * (SHADES.length - 1), k = Math.min(Math.floor(at), SHADES.length - 2);
  return `rgb(${SHADES[k].map((v, i) => Math.round(v + (at - k) * (SHADES[k + 1][i] - v))).join(",")})`;
}

// {x: axis with values, y: axis with values, z: {label, unit}, values: rows by y, contours: levels,
//  points: [{label, x, y}]}. Shades and contours go by the logarithm of z.
function mapFigure(figure, data) {
  const xs = figure.x.values, ys = figure.y.values, log = v => (v > 0 ? Math.log10(v) : null);
  const z = figure.values.map(row => row.map(v => (typeof v === "number" ? log(v) : null)));
  const known = z.flat().filter(v => v != null);
  if (!known.length) return [el("p.empty", {}, "There is nothing to draw: no value was computed.")];
  const low = known.reduce((a, b) => Math.min(a, b)), high = known.reduce((a, b) => Math.max(a, b));
  const text = v => unit(number(v, 3), figure.z.unit);
  const draw = width => {
    const area = [80, width - 24, 12, 372], [left, right, top, bottom] = area;
    const root = svg("svg", { width, height: 422, role: "img", "aria-label": figure.title + ", map with contours" });
    const x = plotAxis(figure.x, xs, left, right), y = plotAxis(figure.y, ys, bottom, top);
    const px = xs.map(x.place), py = ys.map(y.place);
    const edge = (p, k, a, b) => (k < 0 ? a : k + 1 >= p.length ? b : (p[k] + p[k + 1]) / 2);
    z.forEach((row, i) => row.forEach((v, j) => {
      const [x1, x2] = [edge(px, j - 1, left, right), edge(px, j, left, right)];
      const [y1, y2] = [edge(py, i, bottom, top), edge(py, i - 1, bottom, top)];
      const cell = svg("rect", { x: x1, y: y1, width: x2 - x1 + 0.6, height: y2 - y1 + 0.6, class: "cell",
        fill: v == null ? "#ffffff" : shade((v - low) / (high - low || 1)) });
      cell.append(svg("title", {}, `${figure.x.label} ${unit(number(xs[j], 4), figure.x.unit)}, `
        + `${figure.y.label} ${unit(number(ys[i], 3), figure.y.unit)}: ${v == null ? "not computed" : text(figure.values[i][j])}`));
      root.append(cell);
    }));
    drawAxes(root, x, y, area);
    for (const level of list(figure.contours)) {
      const pieces = contour(px, py, z, log(level));
      for (const layer of ["contour-ground", "contour"])
        for (const [[x1, y1], [x2, y2]] of pieces) root.append(svg("line", { x1, y1, x2, y2, class: layer }));
      if (!pieces.length) continue;
      const [x1, y1] = pieces[Math.floor(pieces.length / 2)][0];
      plotText(root, x1, y1 - 6, text(level), { class: "contour-label" });
    }
    for (const p of list(figure.points)) {
      if (p.x < xs[0] || p.x > xs[xs.length - 1] || p.y < ys[0] || p.y > ys[ys.length - 1]) continue;
      root.append(svg("circle", { cx: x.place(p.x), cy: y.place(p.y), r: 4.5, class: "mark" }));
      plotText(root, x.place(p.x), y.place(p.y) - 9, p.label, { class: "contour-label" });
    }
    return root;
  };
  const steps = [0, 0.25, 0.5, 0.75, 1];
  const key = el("p.key", {}, figure.z.label + ": ", steps.map(t => {
    const box = svg("svg", { width: 22, height: 12, "aria-hidden": "true", class: "swatch" });
    box.append(svg("rect", { width: 22, height: 12, fill: shade(t) }));
    return el("span", {}, box, text(10 ** (low + t * (high - low))));
  }));
  return [key, drawnBox(figure, data, draw), figure.note ? el("p.note", {}, figure.note) : null];
}

// Every other kind is made of curves: "curves" (of the page) and "own_axis".
const DRAWN = { piston_bars: barsFigure, xy: xyFigure, map: mapFigure, scatter: scatterFigure };

// A figure may bring curves of its own, at angles of its own.
const dataOf = (figure, report, data) => !figure.curves ? data
  : { ...prepare(report, figure.curves), mounts: data.mounts, redraws: data.redraws };

function figures(report, data) {
  const figures = list(report.figures).filter(f => f.curves || f.kind === "xy" || f.kind === "map"
    || f.kind === "scatter" || data.order.length);
  if (!figures.length) return null;
  return el("div", {},
    figures.some(f => !DRAWN[f.kind]) ? el("p.hint", {}, "Drag along a plot to zoom the angle, up or down to zoom the value; "
      + "double-click to see all again. Point at a curve to read the values in the table above it.") : null,
    figures.map(f => el("figure", { id: "figure-" + f.id }, el("figcaption", {}, el("h3", {}, f.title),
      f.paper ? el("span.paper", {}, "paper: " + f.paper) : null),
      (DRAWN[f.kind] || curvesFigure)(f, dataOf(f, report, data)))));
}

// ---- The page --------------------------------------------------------------------------------------

// What the sections need of the curves. A run backwards has falling angles: `order` lists the samples by
// rising angle. The axis is rounded out to whole turns where the last step of a turn is all that is missing.
function orderOf(theta, angle) {
  const order = theta.map((_, i) => i).sort((a, b) => theta[a] - theta[b]);
  const first = theta[order[0]], last = theta[order[order.length - 1]];
  const step = order.length > 1 ? (last - first) / (order.length - 1) : 360;
  const turns = (v, round) =>
    (angle && Math.abs(360 * round(v / 360) - v) <= 1.01 * step ? 360 * round(v / 360) : v);
  return { theta, order, step, low: turns(first, Math.floor), high: turns(last, Math.ceil) };
}

function prepare(report, curves) {
  const tables = list(curves.tables).map(t => ({ name: t.name, columns: t.columns || {} }));
  const channels = new Map(list(report.channels).map(c => [c.name, c]));
  const about = name => channels.get(name) || {};
  const usual = ["analytic", "multibody"];
  const pair = [0, 1].map(i => (tables[i] || list(report.models)[i] || {}).name || usual[i]);
  return {
    ...orderOf(list(curves.theta_deg), true), axis: { label: "shaft angle (deg)", angle: true }, tables, pair,
    difference: curves.difference || {}, mounts: [], redraws: [],
    ofTable: (row, i) => row[pair[i]] ?? row[usual[i]] ?? null,
    meaning: name => phrases(about(name).meaning, about(name).on_body && "on " + about(name).on_body),
    pistonOf: name => String(about(name).piston || name),
  };
}

const SECTIONS = [
  ["verdict", "Verdict", verdictBanner], ["summary", "Summary", summary], ["warnings", "Warnings", warnings],
  ["common", "Common to both models", commonInputs], ["validity", "Validity over the turn", validity],
  ["comparison", "Comparison", comparison], ["assumptions", "Assumptions", assumptionSplit],
  ["runs", "Runs", runs], ["published", "Against the published numbers", published],
  ["checks", "Checks of each model", checks],
  ["figures", "Figures", figures], ["case", "Case", caseTable], ["derived", "Derived quantities", derived],
  ["models", "How each model was obtained", models], ["versions", "Versions", versions],
];

function header(report, data) {
  const { theta, tables } = data, n = theta.length;
  const angles = n === 0 ? null : n === 1 ? "1 angle, " + degrees(theta[0])
    : `${n} angles from ${degrees(theta[0])} to ${degrees(theta[n - 1])}`;
  const parts = [report.case && report.case.file, tables.map(t => t.name).join(" and "), angles,
                 list(list(report.program)[0]).join(" ")];
  return [el("h1", {}, report.title || document.title),
          el("p", {}, parts.filter(Boolean).map(p => el("span", {}, p)))];
}

// Contents beside the report where there is room, folded above it where there is not.
function contents(sections, report) {
  const link = (id, text, inner) => el("li", {}, el("a", { href: "#" + id }, text), inner);
  const inner = () => el("ul", {}, report.figures.map(f => link("figure-" + f.id, f.title)));
  const folding = el("details", {}, el("summary", {}, "Contents"),
    el("ul", {}, sections.map(s => link(s.id, s.title, s.id === "figures" ? inner() : null))));
  const wide = matchMedia("(min-width: 1100px)");
  const fold = () => { folding.open = wide.matches; };
  wide.addEventListener("change", fold);
  fold();
  const links = new Map([...folding.querySelectorAll("a")].map(a => [a.getAttribute("href").slice(1), a]));
  folding.addEventListener("click", e => { if (e.target.closest("a") && !wide.matches) folding.open = false; });
  const watcher = new IntersectionObserver(entries => entries.forEach(e => {
    const a = links.get(e.target.id);
    if (e.isIntersecting) a.setAttribute("aria-current", "true"); else a.removeAttribute("aria-current");
  }), { rootMargin: "-15% 0px -80% 0px" });
  links.forEach((_, id) => watcher.observe(document.getElementById(id)));
  return folding;
}

// Canvases do not follow the width of the paper by themselves.
function fitToPaper(redraws) {
  const fit = printing => {
    document.documentElement.classList.toggle("printing", printing);
    redraws.forEach(redraw => redraw());
  };
  addEventListener("beforeprint", () => fit(true));
  addEventListener("afterprint", () => fit(false));
}

function render() {
  const read = id => JSON.parse(document.getElementById(id).textContent);
  const report = read("report"), data = prepare(report, read("curves") || {});
  document.getElementById("head").append(...header(report, data));
  const main = document.getElementById("main");
  const shown = [];
  for (const [id, title, build] of SECTIONS) {
    const body = build(report, data);
    if (!body) continue;
    main.append(el("section", { id, "aria-labelledby": id + "-title" },
      el("h2", { id: id + "-title" }, title), body));
    shown.push({ id, title });
  }
  data.mounts.forEach(mount => mount());  // a plot needs its box in the page, to know its width
  document.getElementById("contents").append(contents(shown, report));
  fitToPaper(data.redraws);
}

try {
  render();
  document.documentElement.dataset.ready = "true";
} catch (error) {
  document.body.prepend(el("p.error-box", { role: "alert" }, "This report could not be drawn: " + error.message
    + ". The numbers are in report.json and in the CSV files of the same directory."));
  document.documentElement.dataset.ready = "error";
  console.error(error);
}
})();
