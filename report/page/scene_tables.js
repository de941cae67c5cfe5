// What the 3-D view says in words and numbers: tables of loads, sums of a body, the film's point on its plate.

const forceText = (v, name) => unit(number(v, 5), name);
const kilo = (v, name) => (v >= 1e3 ? unit(number(v / 1e3, 4), "k" + name) : unit(number(v, 4), name));

// Loads at a row as a table: per model the size and the components in S1.
function loadsTable(state, loads, row, models) {
  const component = v => (v == null ? DASH : number(Math.abs(v) < 1e-3 ? Number(v.toFixed(6)) : v, 5));
  const rows = loads.flatMap(load => models.flatMap(model => {
    const at = state.loadAt(load, row, model);
    return [["force", "N"], ["moment", "Nm"]].filter(([part]) => at[part]).map(([part, name]) => ({ load, model, name, v: at[part] }));
  }));
  return table([
    { head: "Load", main: true, cell: r => r.load.label },
    { head: "Model", cell: r => state.models[r.model] },
    { head: "On", cell: r => r.load.on }, { head: "By", cell: r => r.load.by }, { head: "At", cell: r => r.load.point },
    { head: "Size", num: true, cell: r => forceText(lengthOf(r.v), r.name) },
    ...["x1", "y1", "z1"].map((axis, k) => ({ head: axis, num: true, cell: r => component(r.v[k]) })),
  ], rows, { fold: false });
}

// Sums over a body: of the numbers in the page, and the program's own over all rows.
function sumsTable(state, body, row) {
  const said = list(state.scene.sums).find(s => s.body === body);
  const share = v => (v == null ? DASH : number(v, 2));
  return table([
    { head: "Sum of all loads on the " + body, main: true, cell: m => state.models[m] },
    { head: "force left", num: true, cell: m => unit(number(lengthOf(state.sumOf(body, row, m).force), 2), "N") },
    { head: "over the sum of sizes", num: true, cell: m => share(state.sumOf(body, row, m).force_over_sum) },
    { head: "moment left", num: true, cell: m => unit(number(lengthOf(state.sumOf(body, row, m).moment), 2), "Nm") },
    { head: "over the sum of sizes", num: true, cell: m => share(state.sumOf(body, row, m).moment_over_sum) },
    ...(said ? [{ head: "program, largest of all rows: force", num: true, cell: m => share(said.force_over_sum[m]) },
                { head: "moment", num: true, cell: m => share(said.moment_over_sum[m]) }] : []),
  ], state.models.map((_, m) => m), { fold: false });
}

// One load in words, for who points at it.
function loadWords(state, { load, model, kind, v }, difference) {
  const name = kind === "moment" ? "Nm" : "N", axes = list(load.axes).length ? load.axes : ["x1", "y1", "z1"];
  const components = state.componentsOf(load, v).map((c, i) => `${axes[i]} ${difference ? small(c) : number(c, 5)}`).join(", ");
  return [
    `${load.label}${kind === "moment" && list(load.force).length ? ", moment" : ""}: ${unit(difference ? small(lengthOf(v)) : number(lengthOf(v), 6), name)}`,
    `${components} (${load.frame || "S1"})`,
    `on the ${load.on}, by the ${load.by}, at ${load.point}`,
    difference ? `${state.models[1]} minus ${state.models[0]}` : state.models[model],
  ];
}

// The largest of each group that is shown, in one sentence.
function largestWords(state, groups, row, models) {
  return groups.map(({ name, loads }) => {
    let best = null;
    for (const load of loads) {
      const { force, moment } = state.loadAt(load, row, models[0]), v = force || moment;
      if (v && (!best || lengthOf(v) > best.size)) best = { load, size: lengthOf(v), name: force ? "N" : "Nm" };
    }
    if (!best) return null;
    // What is drawn as a dot is zero here too.
    const peak = state.peakOf(["largest", loads.length, loads[0].id].join(), loads)[best.name === "N" ? "force" : "moment"];
    return `${best.load.label} ${kilo(best.size < NOTHING * peak ? 0 : best.size, best.name)}`;
  }).filter(Boolean).join("; ");
}

// x and y of a flat list of points.
const pairsOf = flat => Array.from({ length: flat.length / 3 }, (_, i) => [flat[3 * i], flat[3 * i + 1]]);

// The film's point on its plate, to scale, with its path over all rows; against the plate's z: x right, y up.
function filmInset(state) {
  const place = state.scene.film_point;
  if (!place) return null;
  const body = state.bodies.get(place.body), outlines = [];
  for (const s of list(body && body.shapes)) {
    if (s.prism) outlines.push(...[s.prism.outline, ...list(s.prism.holes)].map(points => ({ points, look: s.look, closed: true })));
    if (s.wire) outlines.push({ points: pairsOf(s.wire.points), look: s.look, closed: s.wire.closed });
  }
  const reach = outlines.reduce((most, o) => o.points.reduce((m, p) => Math.max(m, Math.hypot(p[0], p[1])), most), 0) || state.scene.radius / 3;
  const size = 1.25 * reach;
  const path = state.models.map((_, m) => Array.from({ length: state.rows }, (_, i) => state.vectorOf(place.at, i, m)));
  const text = points => points.map(([x, y]) => `${(1e3 * x).toFixed(3)},${(-1e3 * y).toFixed(3)}`).join(" ");
  const root = svg("svg", { viewBox: [-size, -size, 2 * size, 2 * size].map(v => (1e3 * v).toFixed(3)).join(" "), role: "img" });
  for (const o of outlines)
    root.append(svg(o.closed ? "polygon" : "polyline", { points: text(o.points), class: "outline", fill: "none",
      stroke: ["delivery", "suction"].includes(o.look) ? onGround(LOOKS[o.look]) : "currentColor", "vector-effect": "non-scaling-stroke" }));
  // Closer than the rows where the scene has it: lines between few rows would cross the plate as a star.
  const dense = list(state.scene.film_path);
  const line = (points, m) => points.length > 1 && root.append(svg("polyline", { points: text(points), fill: "none",
    stroke: onGround(COLOURS[m ? 6 : 3]), "stroke-width": m ? 1.2 : 3, "stroke-dasharray": m ? "5 3" : "none", "vector-effect": "non-scaling-stroke" }));
  dense.forEach(piece => line(piece, 0));
  path.forEach((points, m) => {
    const known = points.filter(p => p.every(Number.isFinite));
    if (dense.length) {
      if (m) known.forEach(([x, y]) => root.append(svg("circle", { cx: (1e3 * x).toFixed(3), cy: (-1e3 * y).toFixed(3),
        r: (0.006 * 1e3 * size).toFixed(3), fill: onGround(COLOURS[6]) })));
      return;
    }
    let run = [];
    points.forEach(p => {
      if (p.every(Number.isFinite)) return run.push(p);
      line(run, m);
      run = [];
    });
    line(run, m);
  });
  const dot = svg("circle", { r: (0.035 * 1e3 * size).toFixed(3), fill: onGround("#d55e00"), stroke: "currentColor", "vector-effect": "non-scaling-stroke" });
  root.append(dot);
  const words = el("p.hint");
  return {
    node: el("div.film-point", {}, el("h3", {}, "Fh's point on the plate"), root, words),
    show(row, model) {
      const [x, y] = path[model][row], known = Number.isFinite(x) && Number.isFinite(y);
      const away = Math.hypot(x, y), inside = Math.min(1, 0.97 * size / away) || 1;
      dot.setAttribute("visibility", known ? "visible" : "hidden");
      if (known) {
        dot.setAttribute("cx", (1e3 * x * inside).toFixed(4));
        dot.setAttribute("cy", (-1e3 * y * inside).toFixed(4));
      }
      words.textContent = !known ? "Not computed at this row."
        : `x ${number(1e3 * x, 4)} mm, y ${number(1e3 * y, 4)} mm: ${number(1e3 * away, 4)} mm from the centre`
          + (inside < 1 ? "; outside the picture" : "");
      root.setAttribute("aria-label", "Point of the film force on the plate, with its path: " + words.textContent);
    },
  };
}
