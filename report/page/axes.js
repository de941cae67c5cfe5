// Axes of everything that is drawn as SVG, in the pixels of its box, so that text keeps its size at every width.

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

// Multiples of 1, 2 or 5 times a power of ten.
function roundTicks(low, high, most) {
  const power = 10 ** Math.floor(Math.log10((high - low) / most));
  const step = power * [1, 2, 5, 10].find(m => m * power * most >= high - low);
  const ticks = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) ticks.push(k * step);
  return ticks;
}

// One axis from `from` to `to` between two pixels: place of a value, and ticks.
function plotAxis({ name, from, to }, [first, last]) {
  const place = v => first + (last - first) * (v - from) / (to - from);
  const ticks = roundTicks(from, to, 8), labels = tickLabels(ticks);
  return { place, name, ticks: ticks.map((v, i) => ({ v, label: labels[i] })) };
}

const plotText = (root, x, y, content, more) =>
  root.append(svg("text", { x, y, "text-anchor": "middle", ...more }, content));

// Grid, ticks and names of both axes; `style` of a tick's line. An axis without ticks has only a name.
function drawAxes(root, x, y, [left, right, top, bottom], style = () => "grid") {
  for (const t of x.ticks) {
    root.append(svg("line", { x1: x.place(t.v), x2: x.place(t.v), y1: top, y2: bottom, class: style(t) }));
    plotText(root, x.place(t.v), bottom + 18, t.label);
  }
  for (const t of y.ticks) {
    root.append(svg("line", { x1: left, x2: right, y1: y.place(t.v), y2: y.place(t.v), class: style(t) }));
    plotText(root, left - 8, y.place(t.v) + 4, t.label, { "text-anchor": "end" });
  }
  plotText(root, (left + right) / 2, bottom + 38, x.name, { class: "axis" });
  const middle = (top + bottom) / 2;
  plotText(root, 14, middle, y.name, { class: "axis", transform: `rotate(-90 14 ${middle})` });
}

// A piece of line for the legend.
function swatch(colour, width, dash) {
  const box = svg("svg", { width: 34, height: 10, "aria-hidden": "true", class: "swatch" });
  box.append(svg("line", { x1: 0, x2: 34, y1: 5, y2: 5, stroke: colour, "stroke-width": width,
                           "stroke-dasharray": dash ? dash.join(" ") : "none" }));
  return box;
}
