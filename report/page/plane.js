// Figures in a plane: points, curves, maps.

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
  const points = all.flatMap(s => s.points);
  const draw = width => {
    const area = [74, width - 14, 12, 380], [left, right, top, bottom] = area;
    const x = plotAxis(figure.x, points.map(p => p.x), [left, right], { most: Math.max(2, (right - left) / 70), room: true });
    const y = plotAxis(figure.y, points.map(p => p.y), [bottom, top], { most: 14, room: true });
    const root = svg("svg", { width, height: 430, role: "img", "aria-label": figure.title + "; the values are in the table" });
    drawAxes(root, x, y, area);
    // What is emphasised lies broad and pale under the rest.
    for (const s of [...all].sort((a, b) => (b.emphasis ? 1 : 0) - (a.emphasis ? 1 : 0))) {
      if (s.line && s.points.length > 1)
        root.append(svg("polyline", { points: s.points.map(p => `${x.place(p.x)},${y.place(p.y)}`).join(" "), fill: "none",
          stroke: s.colour, "stroke-width": s.emphasis ? 8 : 1.3, opacity: s.emphasis ? 0.35 : 1, "stroke-linejoin": "round" }));
      if (s.emphasis) continue;
      for (const p of s.points) {
        const dot = mark(s.index, x.place(p.x), y.place(p.y), s.colour);
        dot.append(svg("title", {}, phrases(p.note, `${figure.x.label} ${small(p.x)}`, `${figure.y.label} ${small(p.y)}`)));
        root.append(dot);
      }
    }
    return root;
  };
  return [key, drawnBox(figure, data, draw), figure.note ? el("p.note", {}, figure.note) : null];
}

// {x: axis, y: axis, series: [{label, x: [..], y: [..]}]}
function xyFigure(figure, data) {
  const all = list(figure.series).map((s, i) => ({ ...s, colour: COLOURS[i % COLOURS.length],
    dash: DASHES[Math.floor(i / COLOURS.length) % DASHES.length] }));
  const draw = width => {
    const area = [80, width - 24, 12, 316];
    const x = plotAxis(figure.x, all.flatMap(s => s.x), [area[0], area[1]]);
    const y = plotAxis(figure.y, all.flatMap(s => s.y), [area[3], area[2]]);
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
    const x = plotAxis(figure.x, xs, [left, right]), y = plotAxis(figure.y, ys, [bottom, top]);
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
