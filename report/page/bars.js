// Figures of each piston's share at one angle.

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
  slider.addEventListener("input", () => {
    update();
    data.cursor.set(data.theta[data.order[Number(slider.value)]], slider);
  });
  data.cursor.follow(chart, slider, x => {
    if (x == null) return;
    slider.value = nearestPlace(data.theta, data.order, x);
    update();
  });
  data.mounts.push(() => { update(); new ResizeObserver(update).observe(chart); });
  return [el("div.slide", {}, el("label", {}, "Shaft angle ", reading), slider, buttons.map(b => b.button)), total,
    el("div.split", {}, el("div", {}, key, chart), numbers)];
}

// Bars with one scale for the whole turn.
function barChart(width, groups, [low, high], figure) {
  const area = [74, width - 10, 12, 236], [left, right, top, bottom] = area;
  const margin = 0.06 * (high - low || 1);
  const y = plotAxis({ name: `share (${figure.unit})`, from: low < 0 ? low - margin : 0, to: high + margin }, [bottom, top]);
  const root = svg("svg", { width, height: 280, role: "img",
                            "aria-label": figure.title + ", bars; the values are in the table" });
  drawAxes(root, { name: "piston", ticks: [] }, y, area, t => (t.label === "0" ? "zero" : "grid"));
  const slot = (right - left) / groups.length;
  const every = Math.ceil(26 / slot);  // not every piston has room for its number when there are many
  groups.forEach((g, i) => {
    const start = left + (i + 0.14) * slot, bar = 0.72 * slot / g.values.length;
    g.values.forEach((v, k) => v != null && root.append(svg("rect", { class: k ? "t1" : "t0",
      x: start + k * bar + 1, width: Math.max(1, bar - 2), y: y.place(Math.max(v, 0)),
      height: Math.abs(y.place(v) - y.place(0)) })));
    if (i % every === 0) plotText(root, left + (i + 0.5) * slot, bottom + 18, g.label);
  });
  return root;
}
