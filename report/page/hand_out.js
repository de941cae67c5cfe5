// A figure as a file: the picture that the program drew, its pixels, its numbers.

const csvField = v => (v == null ? "" : typeof v === "string" && /[",\n]/.test(v) ? `"${v.replace(/"/g, '""')}"` : String(v));
const axisName = axis => axis.label + (axis.unit ? ` (${axis.unit})` : "");

// Columns of equal length: [name, values].
function columnsOf(figure, data) {
  if (figure.kind === "own_axis")
    return [[figure.x.label, figure.x.values], ...[...figure.series, ...list(figure.stack)].map(s => [s.label, s.values]),
      ...list(figure.right && figure.right.series).map(s => [axisName({ label: s.label, unit: figure.right.unit }), s.values])];
  const columns = [[data.axis.angle ? "theta_deg" : data.axis.label, data.theta]];
  // To the digits that the page has.
  const rounded = (values, digits) => values.map(v => (v == null ? v : Number(v.toPrecision(digits))));
  for (const name of figure.channels) {
    for (const t of data.tables) if (t.columns[name]) columns.push([`${name} ${t.name}`, rounded(t.columns[name], 9)]);
    if (data.difference[name]) columns.push([`${name} ${data.pair[1]} minus ${data.pair[0]}`, rounded(data.difference[name], 4)]);
    const held = data.reference && data.reference.held[name];
    if (!held) continue;
    columns.push([`${name} ${data.reference.name}`, held.values]);
    for (const [t, values] of Object.entries(held.difference)) columns.push([`${name} ${t} minus ${data.reference.name}`, values]);
  }
  return [...columns, ...list(figure.extra).map(e => [e.label, e.values])];
}

// A row per point.
const POINTS = {
  xy: f => [["series", axisName(f.x), axisName(f.y)], ...f.series.flatMap(s => s.x.map((x, i) => [s.label, x, s.y[i]]))],
  scatter: f => [["series", axisName(f.x), axisName(f.y), "note"],
    ...f.series.flatMap(s => s.points.map(p => [s.name, p.x, p.y, p.note]))],
  drawing: f => [[f.axis || "theta_deg", "panel", "look", "shape", "x", "y"],
    ...[{ theta_deg: null, lines: list(f.ground), arrows: [] }, ...f.frames].flatMap(frame => [
    ...frame.lines.map(l => [l, l.x.map((x, i) => [x, l.y[i]])]),
    ...frame.arrows.map(a => [a, [[a.x, a.y], [a.x + a.dx, a.y + a.dy]]])].flatMap(([shape, points], k) =>
    points.map(([x, y]) => [frame.theta_deg, shape.panel + 1, f.looks[shape.look].label, k + 1, x, y])))],
  bars: f => [[axisName(f.x), "low", "high", "from", "to", "note"],
    ...f.bars.map(b => [b.label, b.low, b.high, ...(b.interval || [null, null]), b.note])],
  bands: f => [["series", axisName(f.x), axisName(f.y), "low", "high"],
    ...f.bands.flatMap(b => f.x.values.map((x, i) => [b.label, x, b.middle[i], b.low[i], b.high[i]])),
    ...f.lines.flatMap(s => s.x.map((x, i) => [s.label, x, s.y[i], null, null]))],
  parallel: f => [[...f.columns.map(axisName), "marked"], ...f.columns[0].values.map((_, i) =>
    [...f.columns.map(c => (c.words && c.values[i] != null ? c.words[c.values[i]] : c.values[i])), f.marked.includes(i) ? 1 : 0])],
  map: f => [[axisName(f.x), axisName(f.y), axisName(f.z)],
    ...f.values.flatMap((row, i) => row.map((v, j) => [f.x.values[j], f.y.values[i], v]))],
};

function csvOf(figure, data) {
  let rows;
  if (POINTS[figure.kind]) {
    rows = POINTS[figure.kind](figure);
  } else {
    const columns = columnsOf(figure, data);
    rows = [columns.map(c => c[0]), ...columns[0][1].map((_, i) => columns.map(c => c[1][i]))];
  }
  return rows.map(row => row.map(csvField).join(",") + "\n").join("");
}

function save(name, blob) {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function pixelsOf(text) {
  return new Promise((done, fail) => {
    const image = new Image();
    image.onerror = () => fail(new Error("the picture cannot be drawn as PNG"));
    image.onload = () => {
      const canvas = el("canvas", { width: 3 * image.width, height: 3 * image.height });
      canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob(done, "image/png");
    };
    image.src = "data:image/svg+xml," + encodeURIComponent(text);
  });
}

// The buttons of a figure. `picture` holds the program's SVG.
function handOut(figure, data, picture) {
  const svgText = () => new XMLSerializer().serializeToString(picture.querySelector("svg"));
  const files = {
    SVG: () => new Blob([svgText()], { type: "image/svg+xml" }),
    PNG: () => pixelsOf(svgText()),
    CSV: () => new Blob([csvOf(figure, data)], { type: "text/csv" }),
  };
  return el("span.hand-out", {}, Object.entries(files).map(([type, make]) => {
    const button = el("button.small", { type: "button", title: `Save this figure as ${type}`,
                                        "aria-label": `Save "${figure.title}" as ${type}` }, type);
    button.addEventListener("click", async () => save(`${figure.file}.${type.toLowerCase()}`, await make()));
    return button;
  }));
}
