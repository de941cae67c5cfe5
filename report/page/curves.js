// Figures of curves over the shaft angle or an axis of their own.

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

// What a dygraph draws: rows of an angle and the value of every line there.
function plotRows(data, lines) {
  const rows = data.order.map(i => [data.theta[i], ...lines.map(l => l.values[i] ?? null)]);
  // Empty rows at the whole turns: the axis then ends at 360 although the last sample does not.
  const nothing = lines.map(() => null);
  if (data.low < rows[0][0]) rows.unshift([data.low, ...nothing]);
  if (data.high > rows[rows.length - 1][0]) rows.push([data.high, ...nothing]);
  return rows;
}

// One dygraph. lines: {values, colour, width, dash, silent, right}; bands {low, high, colour, alpha} are filled behind the
// curves. `right` names the axis of those lines that have one of their own, `ends` fixes that of the others.
function plot(box, data, lines, bands, yLabel, { right, ends } = {}) {
  const names = lines.map((_, i) => String(i)), rows = plotRows(data, lines);
  const series = {};
  lines.forEach((l, i) => {
    series[i] = { color: l.colour, strokeWidth: l.width, strokePattern: l.dash || null, pointSize: 2.5,
                  drawPoints: rows.length < 20 && !l.silent, highlightCircleSize: l.silent ? 0 : 4,
                  connectSeparatedPoints: !!l.sparse,  // of a reference at fewer angles
                  axis: l.right ? "y2" : "y" };
  });
  // Without the touch handlers a finger on a plot still scrolls the page.
  const { touchstart, touchmove, touchend, ...mouse } = Dygraph.defaultInteractionModel;
  return new Dygraph(box, rows, {
    labels: ["theta", ...names], series, legend: "never", interactionModel: mouse,
    xlabel: data.axis.label, ylabel: yLabel, y2label: right || null, labelsDiv: el("div"),
    axes: { x: { ticker: data.axis.angle ? angleTicks : valueAxisTicks, axisLabelWidth: 44 },
            y: { ticker: valueTicks, axisLabelWidth: 74, pixelsPerLabel: 26, valueRange: ends || null },
            y2: { ticker: valueTicks, axisLabelWidth: 54, pixelsPerLabel: 26, independentTicks: true, drawGrid: false } },
    axisLabelFontSize: 13, xLabelHeight: 20, yLabelWidth: 22, rightGap: 22, yRangePad: 8,
    gridLineColor: variable("--grid"), gridLineWidth: 1, axisLineColor: variable("--axis"),
    underlayCallback(canvas, area, graph) {
      canvas.save();
      canvas.beginPath();
      canvas.rect(area.x, area.y, area.w, area.h);
      canvas.clip();
      for (const band of bands) {
        const edge = values => data.order.filter(i => values[i] != null)
          .map(i => [graph.toDomXCoord(data.theta[i]), graph.toDomYCoord(values[i])]);
        canvas.beginPath();
        for (const [x, y] of [...edge(band.low), ...edge(band.high).reverse()]) canvas.lineTo(x, y);
        canvas.fillStyle = band.colour + (band.alpha || "2e");
        canvas.fill();
      }
      canvas.fillStyle = variable("--axis");
      for (const mark of list(data.marks))  // two rows of ticks at the lower edge
        canvas.fillRect(graph.toDomXCoord(mark.x), area.y + area.h - (mark.upper ? 14 : 6), 1, 6);
      canvas.restore();
      canvas.fillStyle = variable("--axis");
      canvas.fillRect(area.x, Math.round(graph.toDomYCoord(0)), area.w, 1);
    },
  });
}

// Both plots of a figure show the same angles, and hovering one marks and reads out the other, and whatever else follows
// the cursor of their axis.
function synchronise(graphs, data, readOut) {
  const firstRow = data.low < data.theta[data.order[0]] ? 1 : 0;
  graphs.forEach((graph, which) => {
    const others = graphs.filter((_, i) => i !== which);
    graph.updateOptions({
      highlightCallback: (event, x, points, row) => {
        others.forEach(g => g.setSelection(row));
        readOut(row - firstRow);
        data.cursor.set(x, graphs);
      },
      unhighlightCallback: () => {
        others.forEach(g => g.clearSelection());
        readOut(null);
        data.cursor.set(null, graphs);
      },
      zoomCallback: (low, high) => others.forEach(g => {
        const [from, to] = g.xAxisRange();
        if (!graph.isZoomed()) g.updateOptions({ dateWindow: null, valueRange: null });
        else if (from !== low || to !== high) g.updateOptions({ dateWindow: [low, high] });
      }),
    }, true);  // nothing to be drawn anew
  });
  data.cursor.follow(graphs[0].graphDiv, graphs, x => {
    const row = x == null ? null : nearestPlace(data.theta, data.order, x);
    graphs.forEach(g => (row == null ? g.clearSelection() : g.setSelection(row + firstRow)));
    readOut(row);
  });
}

// The first table is drawn wide and pale, the others thin and dashed over it: equal curves stay both visible.
function lineOf(values, colour, t, alone) {
  const pale = t === 0 && !alone;
  return { values, colour: colour + (pale ? "66" : ""), width: pale ? 4.5 : 1.9, dash: DASHES[t % DASHES.length] };
}

// A figure may bring its own axis and curves: {x: {label, angle, values}, series: [{label, values}]}. It is
// then drawn from these alone; `angle` says that the axis is one of shaft angles.
const withOwnAxis = (figure, data) => (!figure.x ? data : {
  ...data, tables: [], difference: {}, reference: null, marks: [], axis: { label: figure.x.label, angle: !!figure.x.angle },
  cursor: cursorOf(figure.x.label),
  ...orderOf(list(figure.x.values), !!figure.x.angle) });

// What a curve may be that is held to another: around that curve, or around zero for the difference from it.
function allowedBand(held, colour, aroundZero) {
  const shifted = (values, by) => values.map((v, i) => (v == null ? null : v + by - (aroundZero ? held.values[i] : 0)));
  return { low: shifted(held.low || held.values, -held.allowed), high: shifted(held.high || held.values, held.allowed), colour };
}
const edgesOf = bands => bands.flatMap(b => [b.low, b.high].map(values => (
  { values, colour: b.colour + "66", width: 0.7, dash: null, silent: true, sparse: true })));

// Areas upon each other: two for each of the parts, above and below 0.
function stacked(parts) {
  const above = [], below = [];
  return parts.flatMap(part => [[above, v => v > 0], [below, v => v < 0]].map(([sum, counts]) => {
    const low = part.values.map((_, i) => sum[i] || 0);
    part.values.forEach((v, i) => { sum[i] = (sum[i] || 0) + (counts(v) ? v : 0); });
    return { low, high: [...sum], colour: part.colour, alpha: "99" };
  }));
}

function curvesFigure(figure, page) {
  const data = withOwnAxis(figure, page);
  const heldOf = name => (data.reference && data.reference.held[name]) || null;
  const reference = list(figure.channels).some(heldOf) ? data.reference.name : null;
  const tables = data.tables.map(t => t.name).concat(reference || []);
  const drawn = [], missing = [], lines = [], differences = [], fromReference = [], bands = [], zeroBands = [];
  list(figure.channels).forEach((name, i) => {
    const colour = onGround(COLOURS[i % COLOURS.length]), held = heldOf(name);
    const columns = data.tables.map(t => (hasNumbers(t.columns[name]) ? t.columns[name] : null));
    columns.forEach((c, t) => c || missing.push(`${name} (${data.tables[t].name})`));
    const alone = columns.filter(Boolean).length < 2;
    columns.forEach((values, t) => values && lines.push(lineOf(values, colour, t, alone)));
    const difference = hasNumbers(data.difference[name]) ? data.difference[name] : null;
    if (difference) differences.push({ values: difference, colour, width: 1.5 });
    if (reference) columns.push(held && held.values);
    if (held) {
      lines.push({ ...lineOf(held.values, colour, 2), width: 2.4, sparse: true });
      bands.push(allowedBand(held, colour, false));
      zeroBands.push(allowedBand(held, colour, true));
      Object.values(held.difference).forEach((values, t, all) => fromReference.push({ ...lineOf(values, colour, t, all.length < 2), sparse: true }));
    }
    if (columns.some(Boolean)) drawn.push({ name, colour, columns, difference, held });
  });
  const extras = list(figure.extra).filter(e => hasNumbers(e.values)).map((e, i) => ({
    ...e, colour: onGround(EXTRA_COLOURS[i % EXTRA_COLOURS.length]), width: 1.6, dash: [10, 4, 2, 4] }));
  const parts = list(figure.stack).map((e, i) => ({ ...e, colour: onGround(COLOURS[i % COLOURS.length]), width: 8, dash: null, area: true }));
  const palette = parts.length ? EXTRA_COLOURS : COLOURS;
  list(figure.series).filter(e => hasNumbers(e.values)).forEach((e, i) => extras.push({
    ...e, colour: onGround(palette[i % palette.length]), width: 1.9, dash: null }));
  const right = figure.right && axisName({ label: figure.right.value, unit: figure.right.unit });
  list(figure.right && figure.right.series).filter(e => hasNumbers(e.values)).forEach((e, i) => extras.push({
    ...e, label: e.label + " (right)", unit: figure.right.unit, right: true, width: 1.9, dash: DASHES[1],
    colour: onGround(COLOURS[(list(figure.series).length + i) % COLOURS.length]) }));
  bands.push(...stacked(parts));
  const edges = edgesOf(bands);
  extras.unshift(...parts);
  const notes = missing.length ? ["Not computed: " + missing.join(", ") + "."] : [];
  const footer = () => notes.map(n => el("p.note", {}, n));
  if (!drawn.length && !extras.length)
    return [el("p.empty", {}, "There is nothing to draw: no model computed these channels."), ...footer()];

  const readings = readOutTable(figure, drawn, extras, tables, reference, data);
  const label = figure.unit ? ` (${figure.unit})` : "";
  const box = (style, what) => el("div.plot" + style, { role: "img", "aria-label": `${figure.title}: ${what}` });
  const exact = differences.length > 0 && differences.every(d => d.values.every(v => !v));
  const plots = [{ node: box("", `curves over ${data.axis.label}`), lines: [...edges, ...lines, ...extras.filter(e => !e.area)], bands,
                   label: figure.value || "value", more: { right, ends: figure.ends } }];
  if (differences.length && !exact)
    plots.push({ node: box(".low", `difference over ${data.axis.label}`), lines: differences, bands: [], label: "difference",
                 title: `Difference: ${data.pair[1]} minus ${data.pair[0]}` });
  if (exact) notes.push("The difference is exactly zero wherever both were computed.");
  if (fromReference.length)
    plots.push({ node: box(".low", `difference from ${reference}`), lines: [...edgesOf(zeroBands), ...fromReference], bands: zeroBands,
                 label: "difference", title: `Difference: each model minus ${reference}; the band is what is allowed` });
  if (data.order.length < 2) return [readings.node, ...footer()];  // one angle makes no curve
  data.mounts.push(() => whenNear(plots[0].node, () => {
    const graphs = plots.map(p => plot(p.node, data, p.lines, p.bands, p.label + label, p.more));
    synchronise(graphs, data, readings.show);
  }));
  return [readings.node, ...plots.flatMap(p => [p.title ? el("p.subplot", {}, p.title) : null, p.node]), ...footer()];
}

// Curves with bands about them. Other lines may stand at places of their own: all are drawn over the places of all.
function bandsFigure(figure, page) {
  const places = [...new Set([figure.x, ...figure.lines.map(l => ({ values: l.x }))].flatMap(x => x.values))]
    .filter(v => v != null).sort((a, b) => a - b);
  const at = (x, values) => {
    const known = new Map(x.map((v, i) => [v, values[i]]));
    return places.map(v => known.get(v) ?? null);
  };
  const own = withOwnAxis({ x: { ...figure.x, label: axisName(figure.x) } }, page), all = orderOf(places, false);
  const data = { ...own, ...all, low: Math.min(own.low, all.low), high: Math.max(own.high, all.high) };
  const bands = figure.bands.map((b, k) => ({ label: b.label, colour: onGround(COLOURS[k % COLOURS.length]), width: 1.6, dash: null,
    sparse: true, values: at(figure.x.values, b.middle), low: at(figure.x.values, b.low), high: at(figure.x.values, b.high) }));
  const lines = figure.lines.map((l, k) => ({ label: l.label, colour: onGround(EXTRA_COLOURS[k % EXTRA_COLOURS.length]), width: 1.6,
    dash: [8, 4], sparse: true, values: at(l.x, l.y) }));
  if (data.order.length < 2) return [el("p.empty", {}, "There is nothing to draw.")];
  const readings = readOutTable({ unit: figure.y.unit }, [], [...bands, ...lines], [], null, data);
  const node = el("div.plot", { role: "img", "aria-label": `${figure.title}: curves and bands over ${data.axis.label}` });
  data.mounts.push(() => whenNear(node, () => synchronise(
    [plot(node, data, [...edgesOf(bands), ...bands, ...lines], bands, axisName(figure.y))],
    data, readings.show)));
  return [readings.node, node];
}

// Legend and hover values in one table above the plots, so that it never covers a curve. While nothing is
// pointed at it shows the angle of the largest difference: from the reference where there is one.
function readOutTable(figure, drawn, extras, tables, reference, data) {
  const gapAt = (d, i) => !reference ? d.difference && d.difference[i]
    : d.held && Object.values(d.held.difference).map(v => v[i]).reduce((a, b) => (Math.abs(b ?? 0) > Math.abs(a ?? 0) ? b : a), null);
  const compared = drawn.filter(d => (reference ? d.held : d.difference));
  let home = 0, largest = 0;
  data.order.forEach((i, row) => compared.forEach(d => {
    if (Math.abs(gapAt(d, i) ?? 0) > largest) { largest = Math.abs(gapAt(d, i) ?? 0); home = row; }
  }));
  const angle = el("span.angle");
  const heading = (...content) => el("th.num", { scope: "col" }, ...content);
  const name = (...content) => el("th", { scope: "row" }, ...content);
  const wide = () => el("td.num", { colspan: Math.max(1, tables.length + (compared.length ? 1 : 0)) });
  const rows = drawn.map(d => ({ ...d, cells: d.columns.map(() => el("td.num")),
                                 gap: compared.length ? el("td.num") : null }));
  const more = extras.map(e => ({ ...e, cell: wide() }));
  const node = el("div.scroll", {}, el("table.readout", {},
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, angle),
      tables.map((t, i) => heading(t, swatch(onGround("#444c55"), i ? 1.8 : 2.6, DASHES[i % DASHES.length]))),
      compared.length ? heading(reference ? `furthest from ${reference}` : "difference") : null,
      tables.length ? null : heading("value"))),
    el("tbody", {},
      rows.map(r => el("tr", {}, name(swatch(r.colour, 4), el("code", { title: data.meaning(r.name) }, r.name)),
        r.cells, r.gap)),
      more.map(e => el("tr", {}, name(swatch(e.colour, e.width, e.dash), e.label), e.cell)))));
  function show(row) {
    const at = row == null ? home : Math.min(Math.max(row, 0), data.order.length - 1);
    const i = data.order[at];
    const why = row != null ? "" : largest > 0 ? " (largest difference)" : data.axis.angle ? " (first angle)" : "";
    angle.textContent = (data.axis.angle ? degrees(data.theta[i])
      : `${data.axis.label}: ${number(data.theta[i])}`) + why;
    const value = (v, name = figure.unit) => unit(number(v, 6), name);
    for (const r of rows) {
      r.columns.forEach((c, t) => { r.cells[t].textContent = value(c && c[i]); });
      if (r.gap) r.gap.textContent = unit(small(gapAt(r, i)), figure.unit);
    }
    for (const e of more)
      e.cell.textContent = value(e.values[i], e.unit) + (e.low && e.low[i] != null ? ` (${number(e.low[i], 6)} to ${value(e.high[i])})` : "");
  }
  show(null);
  return { node, show };
}
