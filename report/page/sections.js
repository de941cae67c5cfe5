// The sections of the report but for the comparison and the figures.

function verdictBanner({ verdict, meaning, plausibility }, data) {
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
  const reference = verdict && verdict.reference;
  const tone = !verdict || verdict.agrees == null ? "neutral" : verdict.agrees ? "good" : "bad";
  const word = verdict && verdict.word || { good: "Agrees", bad: "Differs", neutral: "No verdict" }[tone];
  const beyond = verdict && verdict.not_valid;
  return el("div", {},
    el("div.banner." + (beyond && tone !== "bad" ? "warn" : tone), { role: "status" },
      el("p.word", {}, beyond ? `${word}; not valid ${beyond}` : word),
      el("p.headline", {}, verdict && verdict.headline || "No comparison was made."),
      answers(verdict && verdict.answers, plausibility),
      facts(tiles, ".tiles")),
    reference ? el("div.banner." + (reference.agrees ? "good" : "bad"), {},
      el("p.word", {}, `${reference.name}: ${reference.agrees ? "agrees" : "differs"}`),
      el("p.headline", {}, reference.headline)) : null,
    meaning ? el("p.meaning", {}, meaning) : null);
}

// What the command was asked, before everything else that it found.
// Values that are hardly meant may be of another pump than is thought.
function answers(sentences, plausibility) {
  const doubtful = list(plausibility && plausibility.warnings).map(w => w.code);
  const all = [...list(sentences), ...(doubtful.length ? [`Implausible input, listed below: ${doubtful.join(", ")}. `
    + "If it is an error, the results are those of another pump."] : [])];
  return all.length ? el("ul.answers", {}, ...all.map((sentence) => el("li", {}, sentence))) : null;
}

// What is doubtful about the pump, and its picture, which is in the page as SVG.
function pumpHead({ plausibility }) {
  if (!plausibility) return null;
  const picture = el("div.scroll.pump");
  picture.append(document.querySelector("#picture svg").cloneNode(true));
  return el("div", {},
    !list(plausibility.warnings).length ? null : el("ul.warnings", {}, plausibility.warnings.map(w =>
      el("li", {}, el("strong", {}, "Implausible: " + w.code), el("span", {}, w.text)))),
    !list(plausibility.meant).length ? null : el("p.hint", {}, "Implausible, stated as intended: "
      + plausibility.meant.map(w => `${w.code} (${w.reason})`).join("; ")),
    picture);
}

// What is asked first, and how far the models are apart in it.
function keyFigures({ key_figures: key }) {
  if (!key || !list(key.rows).length) return null;
  const apart = key.models.length > 1;
  const quantity = r => el("span", {}, r.quantity, r.symbol ? [" ", el("code", {}, r.symbol)] : null,
    r.note ? el("small", {}, r.note) : null);
  return table([
    { head: "Quantity", main: true, cell: quantity },
    ...key.models.map((name, i) => ({ head: name, num: true, cell: r => unit(number(r.values[i]), r.unit) })),
    ...(apart ? [{ head: "Difference", num: true, cell: r => unit(small(r.difference), r.unit) },
                 { head: "of the value", num: true, cell: r => ratio(r.over_value) }] : []),
    { head: "at", num: true, cell: r => unit(number(r.at, 6), key.at_unit) },
  ], key.rows, { fold: false });
}

// What a report has to say in words: {text, groups: [{title, lines}]}.
const summary = ({ summary }) => !summary ? null : el("div", {},
  summary.text ? el("p", {}, summary.text) : null,
  list(summary.groups).map(g => el("div.block", {}, g.title ? el("h3", {}, g.title) : null,
    el("ul.plain", {}, list(g.lines).map(line => line.startsWith("- ") ? el("li.item", {}, line.slice(2)) : el("li", {}, line))))));

const warnings = ({ warnings }) => !list(warnings).length ? null :
  el("ul.warnings", {}, warnings.map(w => el("li", {}, el("strong", {}, w.name), el("span", {}, w.text))));

const commonInputs = ({ common }) => !list(common).length ? null : table([
  { head: "Input", main: true, cell: r => r.input },
  { head: "How both models get it", cell: r => r.value },
  { head: "What would catch an error in it", cell: r => r.caught_by || DASH },
], common);

const inTime = ({ validity }) => "time_s" in validity[0];  // in the rows of a motion; else over a turn
const validity = ({ validity }) => !list(validity).length ? null : table([
  { head: "Limit", main: true, cell: r => r.limit },
  { head: "State", cell: r => chip(r.violated == null ? "not computed" : r.violated ? "violated" : "holds") },
  { head: inTime({ validity }) ? "Share of the rows" : "Share of the turn", num: true, cell: r => unit(number(r.share_percent, 3), "%") },
  { head: "Worst value", num: true, cell: r => unit(number(r.worst), r.unit) },
  { head: "at", num: true, cell: r => "time_s" in r ? unit(number(r.time_s == null ? null : 1e3 * r.time_s, 4), "ms") : degrees(r.theta_deg) },
  { head: "Consequence where violated", cell: r => r.consequence || DASH },
], validity, { rowClass: r => (r.violated ? "flag" : "") });

// Speeds that must reach the case's own: their limit is the smallest value allowed.
const isMinimum = r => ["suction-speed", "filling-speed"].includes(r.code);
const timing = ({ timing }) => !list(timing).length ? null : table([
  { head: "Quantity", main: true, cell: r => r.quantity },
  { head: "State", cell: r => r.limit == null ? DASH : r.meant ? "meant: " + r.meant : chip(!r.flagged ? "holds" : isMinimum(r) ? "too low" : "exceeded") },
  { head: "Value", num: true, cell: r => unit(number(r.value), r.unit) },
  { head: "Limit", num: true, cell: r => r.limit == null ? DASH : (isMinimum(r) ? "at least " : "") + number(r.limit) },
  { head: "Chamber angles", cell: r => list(r.angles).map(([a, b]) => `${number(a)} to ${number(b)}°`).join(", ")
      || (r.theta_deg == null ? DASH : degrees(r.theta_deg)) },
  { head: "Details", cell: r => r.text || DASH },
], timing, { rowClass: r => (r.flagged && !r.meant ? "flag" : "") });

// What the drive torque and power go into. Values are one per model; round-off of the largest is shown as 0.
function budget({ budget }) {
  if (!budget) return null;
  const value = (v, name, whole) => unit(number(Math.abs(v) < 1e-12 * whole && v != null ? 0 : v), name);
  const perModel = (text, cell) => budget.models.map((name, i) => ({ head: name + text, num: true, cell: r => cell(r, i) }));
  const largest = rows => Math.max(0, ...rows.flatMap(r => r.values.map(Math.abs)));
  const quantities = (title, rows, whole) => !list(rows).length ? null : el("div.block", {}, el("h3", {}, title), table([
    { head: "Quantity", main: true, cell: r => r.name },
    ...(rows.some(r => r.kind) ? [{ head: "Kind", cell: r => r.kind || DASH }] : []),
    ...perModel("", (r, i) => value(r.values[i], r.unit, whole)),
    { head: "Meaning", cell: r => r.note || DASH }], rows));
  const peak = Math.max(0, ...budget.torque.flatMap(r => [...r.least, ...r.greatest].map(Math.abs)));
  return el("div", {}, budget.text ? el("p", {}, budget.text) : null,
    table([
      { head: "Torque for", main: true, cell: r => r.cause },
      ...perModel(", mean", (r, i) => value(r.mean[i], "Nm", peak)),
      { head: "over the turn", num: true, cell: r => value(r.least[0], "", peak) + " to " + value(r.greatest[0], "Nm", peak) },
      { head: "of the mean, to carry the block", num: true, cell: r => value(r.carrying[0], "Nm", peak) },
      ...(budget.torque.some(r => r.verdict) ? [{ head: "Largest difference", num: true, cell: r => unit(small(r.max_abs), "Nm") },
                                                { head: "Verdict", cell: r => chip(r.verdict) }] : []),
    ], budget.torque),
    quantities("Power, mean over the turn", budget.power, largest(budget.power)),
    quantities("Efficiency", budget.efficiency, 0), quantities("Balance of the block on its plate", budget.block, 0));
}

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

const runs = ({ runs }) => !list(runs).length ? null : el("div", {}, runs.map((run, i) => el("div.block", { id: "table-" + (i + 1) },
  runs.length > 1 ? el("h3", {}, run.title) : null, run.text ? el("p", {}, run.text) : null, facts(run.facts),
  !run.table || !list(run.table.rows).length ? null : table(run.table.columns.map((head, i) => ({
    head, main: i === 0, num: run.table.rows.every(r => r[i] == null || typeof r[i] === "number"),
    cell: r => small(r[i]) })), run.table.rows, { fold: false, style: ".narrow" }))));

function published({ published }, data) {
  if (!published || !list(published.rows).length) return null;
  const counts = new Map();
  for (const { verdict } of published.rows) counts.set(verdict, (counts.get(verdict) || 0) + 1);
  return el("div", {},
    published.text ? el("p", {}, published.text) : null,
    el("details.others", {},
      el("summary", {}, `All ${published.rows.length} rows: ` + [...counts].map(([word, n]) => `${n} ${word}`).join(", ")),
      table([
        { head: "Quantity", main: true, cell: r => r.quantity },
        ...(published.rows.some(r => r.at) ? [{ head: "At", cell: r => r.at || DASH }] : []),
        { head: "Paper", cell: r => number(r.paper) },
        ...data.pair.map((name, i) => ({ head: name, num: true, cell: r => unit(number(data.ofTable(r, i)), r.unit) })),
        { head: "Verdict", cell: r => chip(r.verdict) },
        { head: "Status", cell: r => r.status || DASH },
        { head: "Where", cell: r => r.where || DASH },
      ], published.rows, { fold: false })));
}

const checks = ({ checks }) => !list(checks).length ? null : table([
  { head: "Check", main: true, cell: r => r.name },
  { head: "Model", cell: r => r.model },
  { head: "Verdict", cell: r => chip(r.verdict) },
  { head: "Worst", num: true, cell: r => unit(small(r.worst), r.unit) },
  { head: "Scale", num: true, cell: r => unit(number(r.scale), r.unit) },
  { head: "Relative", num: true, cell: r => small(r.relative) },
  { head: "Tolerance", num: true, cell: r => small(r.tolerance) },
  { head: "at", num: true, cell: r => degrees(r.theta_deg) },
], checks, { fold: false, rowClass: r => (r.verdict === "violated" ? "flag" : "") });

function caseTable(report) {
  const entries = list(report.case && report.case.entries);
  if (!entries.length) return null;
  const tables = [...new Set(entries.map(e => e.table || ""))];
  return el("div", {}, report.case.file ? el("p", {}, "Case file ", el("code", {}, report.case.file)) : null,
    el("div.columns", {}, tables.map(name => el("div.block", {}, el("h3", {}, name ? `[${name}]` : "top level"),
      facts(entries.filter(e => (e.table || "") === name).map(e => [e.key, el("span", {}, String(e.value),
        e.defaulted ? el("span.default", {}, "default") :
          e.changed ? el("span.default", {}, "--set") : null)]), ".rows")))));
}

const derived = ({ derived }) => !list(derived).length ? null : table([
  { head: "Quantity", main: true, cell: r => r.name },
  { head: "Symbol", cell: r => r.symbol || DASH },
  { head: "Value", num: true, cell: r => unit(number(r.value), r.unit) },
  { head: "From", cell: r => r.source || DASH },
], derived, { fold: false });

function models({ models }) {
  const time = m => (m.seconds == null ? [] : [["time", unit(number(m.seconds, 3), "s")]]);
  return !list(models).length ? null : el("div.cards", {}, models.map(m => el("div.block.card", {},
    el("h3", {}, m.name), facts([...list(m.facts), ...time(m)], ".pairs"),
    list(m.assumptions).length ? [el("h4", {}, "Assumptions"), facts(m.assumptions, ".pairs")] : null)));
}

// Where the report comes from, at its end.
const versions = ({ program, provenance: from }) => el("div", {},
  !from ? null : el("div.block", {}, facts([["command", el("code", {}, from.command)], ["date", from.date],
    ...from.inputs.slice(0, 3).map(i => [i.file, el("span", {}, "SHA-256 ", el("code", {}, i.sha256))]),
    ...from.machine.filter(([name]) => name === "system")], ".pairs"),
    from.inputs.length <= 3 ? null : el("details", {}, el("summary", {}, `All files read (${from.inputs.length})`),
      facts(from.inputs.map(i => [i.file, el("code", {}, i.sha256)]), ".pairs"))),
  facts(program, ".pairs"));
