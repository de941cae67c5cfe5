// The page of the pump: parameters, curves and the pump in space, kept in step with the worker, which computes.
// Knows no physics: parameters come from the registry, results and words from the program's own report.

const byId = id => document.getElementById(id);
const NAMES = ["this design", "kept design"];  // as pump.cpp names the tables
const FIRST = ["pump.tilt_deg", "operation.speed_rpm", "pressure.delivery_bar"];  // what a newcomer moves first
const COMMAND = "bentaxis compare";

// ---- The worker

let worker = null, asked = new Map(), questions = 0, alive = false;

// The worker's script is packed (gzip, base64): the page has a third of its size.
let script = null;
async function workerScript() {
  const bytes = Uint8Array.from(atob(byId("worker").textContent.trim()), c => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).blob();
}

async function startWorker() {
  script = script || URL.createObjectURL(new Blob([await workerScript()], { type: "text/javascript" }));
  if (worker) worker.terminate();
  for (const { fail } of asked.values()) fail(new Error("the computation was started again"));
  asked = new Map();
  alive = false;
  worker = new Worker(script);
  const started = new Promise((done, fail) => asked.set("ready", { done, fail }));
  worker.onmessage = ({ data: { id, ...found } }) => {
    const question = asked.get(id);
    asked.delete(id);
    if (question) question.done(found);
  };
  worker.onerror = event => { event.preventDefault(); died(event.message || "the worker ended"); };
  worker.onmessageerror = () => died("an answer of the worker cannot be read");
  return started.then(found => {
    if (found.error) throw Object.assign(new Error(found.error), { kind: found.kind });
    alive = true;
  });
}

function ask(call, given = {}) {
  const id = ++questions;
  return new Promise((done, fail) => {
    asked.set(id, { done, fail });
    worker.postMessage({ id, call, ...given });
    // A browser that ends a worker for want of memory does not say so.
    setTimeout(() => { if (asked.has(id)) died(`no answer within ${pumpPage.patience / 1000} s`); }, pumpPage.patience);
  });
}

function died(why) {
  const waiting = [...asked.values()];
  asked = new Map();
  alive = false;
  waiting.forEach(({ fail }) => fail(Object.assign(new Error(why), { kind: "died" })));
  trouble("died", why);
}

// ---- What went wrong, said in the page

const ADVICE = {
  input: "Change the value, or reset it. The results below are those of the last valid values.",
  computation: "The model has no result for these values. The results below are those of the last valid values.",
  memory: "There was too little memory for this. Close other pages, or lower [operation] samples_per_revolution; "
    + "the program has no such limit: bentaxis run",
  died: "The part of the page that computes has ended. Your values are kept.",
  none: "This browser has no WebAssembly (or no DecompressionStream), or it is switched off, so the page cannot compute. Use a newer browser, or the program: "
    + "bentaxis show CASE --out out",
};

function trouble(kind, text) {
  const again = kind === "died" || kind === "memory" ? [["Start again", begin]] : [];
  const buttons = again.map(([label, press]) => button(label, press));
  byId("troubles").replaceChildren(el("div.error-box", { "data-kind": kind }, text ? text + "\n" : "", ADVICE[kind] || ADVICE.died,
    el("div", {}, buttons)));
  byId("main").classList.toggle("stale", !!shown);
}
function noTrouble() {
  byId("troubles").replaceChildren();
  byId("main").classList.remove("stale");
}

// A refused value is marked where it is set. The words of --set are those of a command line.
function refuse({ error, kind }) {
  const text = error.replace(/^--set ([^:]*): /, "$1: ").replaceAll("/case/", "");
  trouble(kind === "program" ? "died" : kind, text);
  document.querySelectorAll(".parameter.wrong").forEach(p => p.classList.remove("wrong"));
  const name = /\[([\w.]+)\] (\w+)/.exec(error) || /^--set ([\w.]+)\.(\w+)/.exec(error);
  const control = name && controls.get(`${name[1]}.${name[2]}`);
  if (control) control.node.classList.add("wrong");
}

// ---- What is designed: a case file and what differs from it

const shippedCases = JSON.parse(byId("cases").textContent);
let design = { ...shippedCases[0], changes: {} }, kept = null;
let files = {};             // that a case names, by their path
let opened = new Map();     // parameters of the case as it was opened, by name
let first = null;           // key figures of that case
let tables = [];            // parameters now, by table
const changesOf = one => Object.entries(one.changes).map(([name, value]) => `${name}=${value}`).join("\n");
const given = one => ({ file: one.file, text: one.text, changes: changesOf(one) });
const tomlOf = value => (typeof value === "string" ? JSON.stringify(value) : Array.isArray(value) ? `[${value.join(", ")}]` : String(value));
const nameOf = p => (p.table ? p.table + "." : "") + p.key;
const parametersOf = all => new Map(all.flatMap(t => t.parameters.map(p => [nameOf(p), p])));

function change(name, value) {
  const before = opened.get(name), text = tomlOf(value);
  if (before && tomlOf(before.value) === text) delete design.changes[name]; else design.changes[name] = text;
  const control = controls.get(name);
  if (control) control.show(value);
  update();
}

async function open(next, { keep = null } = {}) {
  if (busy) await new Promise(done => waiters.push(done));
  opening = true;
  try {
    design = { changes: {}, ...next };
    kept = keep;
    first = null;
    shown = null;
    tables = [];
    for (const [path, text] of Object.entries(files)) await ask("file", { path, text });
    const asOpened = { ...given(design), changes: "" }, found = await ask("parameters", asOpened);
    opened = found.tables ? parametersOf(found.tables) : new Map();
    const made = kept && await ask("compute", { which: 1, ...given(kept) });
    if (made && !made.error) keptTurn = await tableOf(made, 1); else await dropKept();
    const start = Object.keys(design.changes).length ? await ask("compute", { which: 0, ...asOpened }) : null;
    if (start && !start.error) first = keyFiguresOf((await ask("document")).report);
  } finally {
    opening = false;
  }
  await update();
}

const keyFiguresOf = r => r && new Map(r.key_figures.rows.map(row => [row.quantity, row.values[0]]));

async function dropKept() {
  kept = null;
  keptTurn = null;
  await ask("compute", { which: -1 });
}

// ---- In step: curves at every answer, words and the pump in space whenever there is time

// While a control moves, words and the pump in space follow four times a second.
const WORDS_EVERY = 250, AT_REST = 120;  // ms
const SAID_AFTER = 400;  // ms: a computation that takes longer, as that of the oil may, is said to be under way
let busy = false, again = false, opening = false, waiters = [], updates = 0, documents = 0, lastDocument = 0, lastChange = 0;
let shown = null, keptTurn = null;  // the last turns: {angles, columns}

// Columns as lists, null where nothing was computed.
async function tableOf({ angles, values, rows, columns }, which) {
  const known = which === 0 && shown && shown.channels.length === columns ? shown.channels : (await ask("channels", { which })).channels;
  const made = {};
  known.forEach(({ name }, c) => {
    const column = new Array(rows);
    for (let row = 0; row < rows; ++row) {
      const value = values[row * columns + c];
      column[row] = value === value ? value : null;
    }
    made[name] = column;
  });
  return { angles: [...angles], channels: known, columns: made };
}

function underWay(is) {
  byId("main").classList.toggle("under-way", is);
  byId("under-way").textContent = is ? "Computing. The results below are those of the values before." : "";
}

// Resolves when the page shows what the design now is.
function update() {
  const settled = new Promise(done => waiters.push(done));
  again = true;
  lastChange = performance.now();
  if (!busy && !opening) keepInStep();
  return settled;
}

async function keepInStep() {
  busy = true;
  try {
    while (again) {
      again = false;
      const late = setTimeout(() => underWay(true), SAID_AFTER);
      const found = await ask("compute", { which: 0, ...given(design) }).finally(() => { clearTimeout(late); underWay(false); });
      if (found.error) {
        refuse(found);
        if (!controls.size) await showParameters();
        continue;
      }
      noTrouble();
      shown = await tableOf(found, 0);
      drawCurves();
      ++updates;
      const soon = () => performance.now() - lastDocument < WORDS_EVERY;
      while (!again && soon() && performance.now() - lastChange < AT_REST) await new Promise(done => setTimeout(done));
      if (again && soon()) continue;
      const said = await ask("document");
      lastDocument = performance.now();
      if (said.error) refuse(said); else drawDocument(said);
      if (!again) await showParameters();
    }
  } catch (error) {
    if (error.kind !== "died") trouble("died", error.message);
  }
  busy = false;
  waiters.splice(0).forEach(done => done());
}

// ---- Parameters

let controls = new Map();

const button = (text, press, attributes = {}) => {
  const made = el("button.small", { type: "button", ...attributes }, text);
  made.addEventListener("click", press);
  return made;
};

// Between the ends of what is plausible, or half and one and a half times the value of the file; within what is allowed.
function sliderRange(p, value) {
  const within = v => Math.min(p.high ?? Infinity, Math.max(p.low ?? -Infinity, v));
  const [low, high] = (p.plausible || []).every(v => v != null) && p.plausible && p.plausible[1] - p.plausible[0] <= 10 * Math.abs(value)
    ? p.plausible : [value - 0.5 * Math.abs(value), value + 0.5 * Math.abs(value)];
  const step = p.type === "integer" ? 1 : 10 ** Math.floor(Math.log10((high - low) / 150) + 1e-9);
  const inside = [within(Math.min(low, value)), within(Math.max(high, value))];
  if (!(inside[1] > inside[0])) return null;
  const round = v => Number((Math.round(v / step) * step).toPrecision(12));
  const ends = [round(inside[0]), round(inside[1])];
  if (p.low_open && ends[0] <= p.low || p.low != null && ends[0] < p.low) ends[0] = round(p.low + step);
  if (p.high_open && ends[1] >= p.high || p.high != null && ends[1] > p.high) ends[1] = round(p.high - step);
  return { min: ends[0], max: ends[1], step };
}

const rangeWords = p => {
  if (p.range) return p.range;
  const low = p.low == null ? null : (p.low_open ? "above " : "from ") + number(p.low);
  const high = p.high == null || p.high > 1e9 ? null : (p.high_open ? "below " : "to ") + number(p.high);
  return [low, high].filter(Boolean).join(" ");
};

function controlOf(p) {
  const name = nameOf(p), id = "p-" + name.replace(/\W/g, "-"), before = opened.get(name) || p;
  const inputs = [];
  const input = (attributes, read = node => node.value) => {
    const node = el(attributes.options ? "select" : "input", { ...attributes, options: null },
      (attributes.options || []).map(word => el("option", { value: word }, word)));
    node.addEventListener("input", () => {
      const value = read(node);
      if (value !== null) change(name, value);
    });
    inputs.push(node);
    return node;
  };
  const numeric = node => (node.value.trim() === "" || !Number.isFinite(Number(node.value)) ? null : Number(node.value));
  let set, show;
  const isNumber = p.type === "number" || p.type === "integer";
  if (isNumber) {
    const range = before.value !== 0 && name !== "operation.samples_per_revolution" ? sliderRange(p, before.value) : null;
    const box = input({ id, type: "number", step: "any", "aria-describedby": id + "-range" }, numeric);
    const slider = range && input({ type: "range", ...range, "aria-label": p.meaning }, numeric);
    set = [slider || el("span"), box];
    show = value => {
      if (slider && document.activeElement !== slider) slider.value = value;
      if (document.activeElement !== box) box.value = Number(Number(value).toPrecision(12));
      if (slider) slider.setAttribute("aria-valuetext", unit(number(value), p.unit));
    };
  } else if (p.type === "choice" || p.type === "flag") {
    const pick = input({ id, options: p.type === "flag" ? ["true", "false"] : p.words }, node => (p.type === "flag" ? node.value === "true" : node.value));
    set = [pick, el("span")];
    show = value => { pick.value = String(value); };
  } else if (p.type === "pair") {
    const pair = () => { const both = boxes.map(numeric); return both.includes(null) ? null : both; };
    const boxes = [0, 1].map(i => input({ id: i ? null : id, type: "number", step: "any", "aria-label": `${p.meaning}, ${i ? "second" : "first"}` }, pair));
    set = boxes;
    show = value => boxes.forEach((box, i) => { if (document.activeElement !== box) box.value = value[i]; });
  } else {
    const box = input({ id, type: "text" });
    set = [box, el("span")];
    show = value => { if (document.activeElement !== box) box.value = value; };
  }
  const back = button("\u21ba", () => { if (opened.has(name)) change(name, opened.get(name).value); },
    { "aria-label": `Reset ${p.meaning}`, title: "Back to the value of the case" });
  back.classList.add("back");
  const words = phrases(p.symbol, name, rangeWords(p));
  const node = el("div.parameter", { "data-name": name }, el("div.name", {},
    el("label", { for: id, title: words }, p.meaning), back),
    el("div.set", {}, set, el("span.of", {}, p.unit)), el("small", { id: id + "-range" }, words));
  const control = {
    p, node, show(value) {
      show(value);
      node.classList.toggle("changed", name in design.changes);
    },
  };
  control.show(p.value);
  return control;
}

// Anew where the case uses others than before, otherwise in place, so that the keyboard stays where it is.
async function showParameters() {
  const found = await ask("parameters", given(design));
  const next = found.tables || tables;
  const names = all => all.map(t => t.parameters.map(p => nameOf(p) + p.type).join()).join("|");
  const same = names(next) === names(tables) && controls.size;
  tables = next;
  if (same) {
    const now = parametersOf(tables);
    controls.forEach((control, name) => { if (now.has(name)) control.show(now.get(name).value); });
    if (!byId("troubles").firstChild) controls.forEach(c => c.node.classList.remove("wrong"));
    return;
  }
  const all = parametersOf(tables);
  const openTables = new Set([...document.querySelectorAll("#parameters [data-table][open]")].map(d => d.dataset.table));
  controls = new Map();
  const made = p => {
    const control = controlOf(p);
    controls.set(nameOf(p), control);
    return control.node;
  };
  const startWith = FIRST.filter(name => all.has(name));
  const search = el("input.search", { type: "search", placeholder: "Find a parameter", "aria-label": "Find a parameter" });
  const groups = tables.filter(t => t.parameters.some(p => !startWith.includes(nameOf(p)))).map(t => el("details", { "data-table": t.name, open: openTables.has(t.name) },
    el("summary", {}, t.name ? [el("span", {}, "["), t.name, el("span", {}, "]")] : "case"),
    t.meaning ? el("p.hint", {}, t.meaning) : null,
    t.parameters.filter(p => !startWith.includes(nameOf(p))).map(made)));
  search.addEventListener("input", () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    controls.forEach(({ node, p }, name) => {
      const text = `${name} ${p.symbol} ${p.meaning}`.toLowerCase();
      node.hidden = !words.every(w => text.includes(w));
    });
    groups.forEach(g => {
      const any = [...g.querySelectorAll(".parameter")].some(n => !n.hidden);
      g.hidden = !any;
      if (words.length) g.open = any;
    });
  });
  const fold = byId("parameters").querySelector(".all");
  byId("parameters").replaceChildren(el("h2", {}, "Parameters"), ...startWith.map(name => made(all.get(name))),
    el("details.all", { open: fold ? fold.open : matchMedia("(min-width: 1100px)").matches }, el("summary", {}, "All parameters"), search, ...groups));
}

// ---- Curves

let report = null, plots = [], curveKey = "";

function curveData() {
  const turns = [shown, keptTurn].filter(Boolean);
  const grid = shown.angles.length;
  return prepare({ channels: shown.channels }, { theta_deg: shown.angles, difference: {},
    tables: turns.filter(t => t.angles.length === grid).map((t, i) => ({ name: NAMES[turns.indexOf(t)], columns: t.columns })) });
}

function lineSet(figure, data) {
  const drawn = [], lines = [];
  figure.channels.forEach((name, i) => {
    const colour = onGround(COLOURS[i % COLOURS.length]);
    const columns = data.tables.map(t => (hasNumbers(t.columns[name]) ? t.columns[name] : null));
    columns.forEach((values, t) => values && lines.push(lineOf(values, colour, t, columns.filter(Boolean).length < 2)));
    if (columns.some(Boolean)) drawn.push({ name, colour, columns, difference: null, held: null });
  });
  return { drawn, lines };
}

function drawCurves() {
  if (!report) return;
  const data = curveData();
  for (const figure of plots) figure.show(data);
}

function liveFigure(figure, data) {
  let latest = data, graph = null, readings = null, near = false, key = "";
  const box = el("div.plot", { role: "img", "aria-label": `${figure.title}: curves over ${data.axis.label}` });
  const place = el("div");
  const node = el("figure", { id: "figure-" + figure.id }, el("figcaption", {}, el("h3", {}, figure.title)), el("div.screen", {}, place, box));
  const label = (figure.value || "value") + (figure.unit ? ` (${figure.unit})` : "");
  function draw() {
    const { drawn, lines } = lineSet(figure, latest);
    node.hidden = !drawn.length;
    if (!drawn.length) return;
    readings = readOutTable(figure, drawn, [], latest.tables.map(t => t.name), null, latest);
    place.replaceChildren(readings.node);
    const now = JSON.stringify([latest.theta.length, lines.map(l => [l.colour, l.width]), label]);
    if (graph && now === key) {
      graph.updateOptions({ file: plotRows(latest, lines) });
      return;
    }
    if (graph) graph.destroy();
    key = now;
    graph = plot(box, latest, lines, [], label);
    synchronise([graph], latest, row => readings.show(row));
  }
  new IntersectionObserver(entries => {
    near = entries[entries.length - 1].isIntersecting;
    if (near) draw();
  }, { rootMargin: "200px 0px" }).observe(box);
  return {
    node, id: figure.id,
    show(next) {
      latest = next;
      if (near) draw();
    },
    redraw() { key = ""; if (near) draw(); },
  };
}

// ---- Words, tables and the pump in space

let sections = new Map();
const SHOWN = [
  ["now", "Results", nowSection], ["curves", "Curves", curvesSection], ["space", "The pump in three dimensions", spaceSection],
  ["key", "Key figures", r => keyFigures(r)], ["oil", "Oil", oilSection], ["changed", "What changed", changedSection],
  ["budget", "Torque and power", r => budget(r)], ["validity", "Validity over the turn", r => validity(r)],
  ["derived", "Derived quantities", r => derived(r)], ["limits", "What this page does not do", limitsSection],
];

// The figures in which a newcomer looks first stand first.
const curveOrder = figures => {
  const wanted = ["bearings", "td"], at = f => (wanted.includes(f.id) ? wanted.indexOf(f.id) : wanted.length);
  return figures.filter(f => f.kind === "curves").sort((a, b) => at(a) - at(b));
};

const largestLoads = r => r.key_figures.rows.filter(row => /bearing force|drive torque, mean/.test(row.quantity));

const sized = (row, i) => (row.unit === "N" ? kilo(row.values[i], "N") : unit(number(row.values[i], 4), row.unit));

function nowSection(r) {
  const warned = r.plausibility.warnings, not = r.verdict.not_valid;
  return el("div", { "aria-live": "polite" },
    el("dl.tiles-now", {}, largestLoads(r).map(row => el("div", {}, el("dt", {}, row.quantity),
      el("dd", {}, sized(row, 0), row.values[1] == null ? null : el("small", {}, "kept: " + sized(row, 1)))))),
    el("ul", {}, r.verdict.answers.map(line => el("li", {}, line))),
    !warned.length ? el("p.quiet", {}, "No plausibility warning.")
      : el("ul.warnings", {}, warned.map(w => el("li", {}, el("strong", {}, w.code), el("span", {}, w.text)))),
    not ? el("p.banner.warn", {}, "No pump behaves like this " + not + ": see validity.") : null);
}

function curvesSection(r) {
  const figures = curveOrder(r.figures), data = curveData(), key = figures.map(f => f.id + f.channels).join();
  if (key === curveKey && sections.has("curves")) return null;  // they are there, and kept in step
  curveKey = key;
  plots = figures.map(f => liveFigure(f, data));
  return el("div", {}, el("p.hint", {}, "Drag along a plot to zoom the angle, up or down to zoom the value; double-click to see all again."),
    plots.map(p => p.node));
}

function spaceSection(r, { scene, picture }) {
  byId("picture").innerHTML = picture;  // drawn by the program itself, which escapes what comes from the case
  const data = curveData();
  data.mounts = [];
  if (scenePanel && sections.has("space") && scenePanel.change(scene, data)) return null;
  const node = pumpInSpace(r, data, scene);
  requestAnimationFrame(() => data.mounts.forEach(mount => mount()));
  return node;
}

function oilSection(r) {
  if (!list(r.runs).length) return el("p.quiet", {}, "The chamber pressures are given: no oil is solved. Parameter ",
    el("code", {}, "pressure.kind"), " = hydraulic of a case with [hydraulics] solves it.");
  const mounts = [];
  const node = el("div", {}, runs(r), r.figures.filter(f => f.kind === "own_axis").map(f => el("figure", { id: "figure-" + f.id },
    el("figcaption", {}, el("h3", {}, f.title)), el("div.screen", {}, curvesFigure(f, { ...curveData(), mounts })),
    f.note ? el("p.note", {}, f.note) : null)));
  requestAnimationFrame(() => mounts.forEach(mount => mount()));
  return node;
}

const valueText = (p, value) => (p.type === "number" ? unit(number(value, 6), p.unit) : Array.isArray(value) ? value.map(v => number(v, 6)).join(", ") : String(value));

function changedSection(r) {
  const now = parametersOf(tables);
  const rows = Object.entries(design.changes).map(([name, text]) => {
    const p = opened.get(name) || now.get(name);
    let value = text;
    try { value = JSON.parse(text); } catch (error) { /* stays text */ }
    return { name, meaning: p ? p.meaning : "", from: p && opened.has(name) ? valueText(p, p.value) : DASH, to: p ? valueText(p, value) : text };
  });
  if (!rows.length) return el("p.quiet", {}, "Nothing: these are the values of the case as it was opened.");
  const effects = !first ? [] : r.key_figures.rows.map(row => ({ row, before: first.get(row.quantity) }))
    .filter(({ row, before }) => typeof before === "number" && typeof row.values[0] === "number" && before !== row.values[0]);
  return el("div", {},
    table([{ head: "Parameter", main: true, cell: c => el("code", {}, c.name) }, { head: "Meaning", cell: c => c.meaning },
           { head: "Case as opened", num: true, cell: c => c.from }, { head: "Now", num: true, cell: c => c.to }], rows),
    !effects.length ? null : table([{ head: "Result", main: true, cell: e => e.row.quantity },
      { head: "Case as opened", num: true, cell: e => unit(number(e.before), e.row.unit) },
      { head: "Now", num: true, cell: e => unit(number(e.row.values[0]), e.row.unit) },
      { head: "Change", num: true, cell: e => (e.before ? (e.row.values[0] > e.before ? "+" : "") + number(100 * (e.row.values[0] - e.before) / Math.abs(e.before), 3) + " %" : DASH) }],
    effects, { fold: false }));
}

function limitsSection() {
  return el("div", {},
  el("ul", {},
    el("li", {}, "It computes by one model, the closed form (analytic). The second model, built of bodies and joints with Simbody, is not in the page, "
      + "so nothing is compared. Save the case, then run both models: ", el("code", {}, `${COMMAND} ${design.file}`)),
    el("li", {}, "Of the oil it shows the periodic state of one turn. Torque over pressure, power by place and orders: ", el("code", {}, `bentaxis pressure ${design.file} --out out`)),
    el("li", {}, "It shows one turn at constant speed. Motion in time: ", el("code", {}, `bentaxis simulate ${design.file}`)),
    el("li", {}, "Sweeps, sensitivities, bearing life and FMUs are in the program only: ", el("code", {}, "bentaxis --help"))),
  el("p", {}, "The numbers are those of the program: the same source, compiled for the browser."));
}

function drawDocument({ report: next, scene, picture }) {
  report = next;
  if (!Object.keys(design.changes).length) first = keyFiguresOf(report);
  ++documents;
  byId("case-line").replaceChildren(el("span.pump-line", {}, report.title), el("span", {}, report.plausibility.summary));
  document.title = report.title + ": bentaxis";
  const main = byId("main");
  if (byId("waiting")) byId("waiting").remove();
  for (const [id, title, build] of SHOWN) {
    const body = build(report, { scene, picture });
    if (!sections.has(id)) {
      const place = el("div");
      main.append(el("section", { id, "aria-labelledby": id + "-title" }, el("h2", { id: id + "-title" }, title), place));
      sections.set(id, place);
    }
    if (!body) continue;
    const place = sections.get(id), openDetails = [...place.querySelectorAll("details")].map(d => d.open);
    place.replaceChildren(body);
    if (id !== "space") [...place.querySelectorAll("details")].forEach((d, i) => { d.open = !!openDetails[i]; });
  }
  document.documentElement.dataset.ready = "true";
  if (pumpPage.firstCurve == null && plots.length) requestAnimationFrame(() => { pumpPage.firstCurve = performance.now(); });
}

// ---- Files and links

function saveCase() {
  ask("text", given(design)).then(found => {
    if (found.error) return refuse(found);
    const link = el("a", { href: URL.createObjectURL(new Blob([found.text], { type: "application/toml" })), download: design.file });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

// A CSV file goes where the case names a file of its name.
async function take(dropped) {
  const texts = await Promise.all(dropped.map(async file => ({ name: file.name, size: file.size, text: file.size <= 8e6 ? await file.text() : null })));
  const large = texts.find(f => f.text === null);
  if (large) return trouble("input", `${large.name}: has ${number(large.size / 1e6, 3)} MB; this page reads files of at most 8 MB.`);
  const cases = texts.filter(f => /\.toml$/i.test(f.name)), others = texts.filter(f => !cases.includes(f));
  if (cases.length > 1) return trouble("input", "More than one case file was given: " + cases.map(f => f.name).join(", ") + ".");
  if (!cases.length && !others.some(f => /\.csv$/i.test(f.name)))
    return trouble("input", `${texts.map(f => f.name).join(", ")}: a case is a file that ends in .toml; its curves end in .csv.`);
  const next = cases.length ? { file: cases[0].name, text: cases[0].text, changes: {} } : design;
  for (const { name, text } of others) {
    const quoted = [...next.text.matchAll(/"([^"\n]*)"/g)].map(m => m[1]).find(path => path.split("/").pop() === name);
    files[quoted || name] = text;
    await ask("file", { path: quoted || name, text });
  }
  // A case that cannot be computed is not opened: the design before it stays.
  const found = await ask("compute", { which: 0, ...given(next) });
  if (found.error) return refuse(found);
  await open(next, { keep: kept });
  return undefined;
}

const bytesOf = async (bytes, Stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new Stream("deflate"))).arrayBuffer());
const toBase64 = bytes => { let text = ""; bytes.forEach(b => { text += String.fromCharCode(b); }); return btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, ""); };
const fromBase64 = text => Uint8Array.from(atob(text.replace(/-/g, "+").replace(/_/g, "/")), c => c.charCodeAt(0));
const plain = one => one && { file: one.file, text: one.text, changes: one.changes };

// The whole case in the part of the address that no server sees.
async function linkText() {
  const text = new TextEncoder().encode(JSON.stringify({ design: plain(design), kept: plain(kept), files }));
  const packed = typeof CompressionStream === "function";
  return "#case=" + (packed ? "z." : "t.") + toBase64(packed ? await bytesOf(text, CompressionStream) : text);
}
async function readLink(hash) {
  const [, kind, data] = /^#case=([zt])\.(.*)$/.exec(hash) || [];
  if (!kind) return null;
  try {
    const bytes = fromBase64(data);
    const state = JSON.parse(new TextDecoder().decode(kind === "z" ? await bytesOf(bytes, DecompressionStream) : bytes));
    const sound = one => one && typeof one.file === "string" && typeof one.text === "string" && one.changes && typeof one.changes === "object";
    if (!sound(state.design) || state.kept && !sound(state.kept)) throw new Error("no case in it");
    return state;
  } catch (error) {
    return { broken: error.message };
  }
}
const LONGEST_LINK = 32000;  // characters: longer ones are cut by some programs
async function makeLink() {
  const hash = await linkText();
  if (hash.length > LONGEST_LINK) return trouble("input", `This case makes a link of ${hash.length} characters, more than ${LONGEST_LINK}: save it as a file.`);
  history.replaceState(null, "", hash);
  const box = el("input.link", { type: "text", readonly: true, value: location.href, "aria-label": "Link to this design" });
  byId("bar").querySelectorAll(".link").forEach(n => n.remove());
  byId("bar").append(box);
  box.select();
  try { await navigator.clipboard.writeText(location.href); } catch (error) { /* the box has it */ }
}

function drawBar() {
  const start = el("select", { "aria-label": "Start from a case of the program" }, shippedCases.map((c, i) => el("option", { value: i }, c.title)));
  start.addEventListener("change", () => { files = {}; open(shippedCases[Number(start.value)]); });
  const chooser = el("input", { type: "file", multiple: true, accept: ".toml,.csv", hidden: true });
  chooser.addEventListener("change", () => { take([...chooser.files]); chooser.value = ""; });
  const keep = button("Keep this design beside", async () => {
    if (kept) {
      await dropKept();
    } else {
      kept = { ...design, changes: { ...design.changes } };
      const made = await ask("compute", { which: 1, ...given(kept) });
      if (made.error) { kept = null; return refuse(made); }
      keptTurn = await tableOf(made, 1);
    }
    keep.setAttribute("aria-pressed", String(!!kept));
    keep.textContent = kept ? "Drop the kept design" : "Keep this design beside";
    await update();
  }, { "aria-pressed": "false" });
  byId("bar").replaceChildren(start, button("Open a case file", () => chooser.click()), chooser, button("Save the case", saveCase),
    button("Link to this design", makeLink), keep, button("Reset", () => { design.changes = {}; update(); }));
}

// ---- Start

async function begin() {
  noTrouble();
  if ([typeof WebAssembly, typeof Worker, typeof DecompressionStream].includes("undefined")) return trouble("none", "");
  try {
    await startWorker();
  } catch (error) {
    return trouble(error.kind || "died", error.message);
  }
  if (controls.size) return open(design, { keep: kept });  // started again: the values are kept
  const link = await readLink(location.hash);
  if (link && link.broken) {
    await open(design);
    return trouble("input", `The link carries no case that can be read (${link.broken}). The default pump is shown.`);
  }
  if (link) files = link.files || {};
  await open(link ? link.design : design, { keep: link ? link.kept : null });
  return undefined;
}

addEventListener("dragover", event => { event.preventDefault(); document.body.classList.add("over"); });
addEventListener("dragleave", event => { if (!event.relatedTarget) document.body.classList.remove("over"); });
addEventListener("drop", event => {
  event.preventDefault();
  document.body.classList.remove("over");
  take([...event.dataTransfer.files]);
});
addEventListener("hashchange", async () => {
  const link = await readLink(location.hash);
  if (link && !link.broken) { files = link.files || {}; open(link.design, { keep: link.kept }); }
});
DARK.addEventListener("change", () => { plots.forEach(p => p.redraw()); sections.delete("space"); update(); });

// For tests and measurements: docs/pump_page.md.
const pumpPage = {
  patience: 30000,  // ms, for one answer
  firstCurve: null, change, open, take, ask, link: linkText, worker: () => worker, begin,
  updates: () => updates, documents: () => documents, shown: () => shown, settled: () => (busy || opening ? new Promise(done => waiters.push(done)) : Promise.resolve()),
  design: () => design,
};
window.bentaxisPump = pumpPage;
startDrawing();
drawBar();
begin();
