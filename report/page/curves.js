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
      compared.length ? heading("difference") : null,
      data.tables.length ? null : heading("value"))),
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
