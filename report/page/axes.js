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

// Powers of ten from `low` to `high`, with steps between them where there are few, unless only `powers` are wanted.
function logTicks(low, high, most, powers) {
  const decades = Math.log10(high / low);
  const digits = powers || decades > 2 ? [1] : decades > 1 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 8];
  const every = Math.max(1, Math.ceil(decades / most));
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
    for (const digit of power % every === 0 ? digits : []) {
      const v = Number((digit * 10 ** power).toPrecision(6));
      if (v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9)) ticks.push({ v, label: powers ? "1e" + power : number(v, 3) });
    }
  return ticks;
}

// One axis: {label, unit, log, from, to}, between two pixels. Place of a value, and about `most` ticks. With `room`
// the ends lie a little beyond the values: 4 % of them, or at the next power of ten.
function plotAxis(spec, values, [first, last], { most = 8, room = false } = {}) {
  const log = Boolean(spec.log);
  const usable = values.filter(v => typeof v === "number" && (!log || v > 0));
  let low = spec.from ?? Math.min(...usable), high = spec.to ?? Math.max(...usable);
  if (spec.from == null && spec.to == null && !usable.length) [low, high] = log ? [0.1, 1] : [0, 1];
  if (room && log) {
    [low, high] = [10 ** Math.floor(Math.log10(low) - 0.05), 10 ** Math.ceil(Math.log10(high) + 0.05)];
  } else if (room) {
    const margin = 0.04 * (high - low) || 0.5;
    [low, high] = [low - margin, high + margin];
  } else if (low === high) {
    [low, high] = log ? [low / 2, high * 2] : [low - 1, high + 1];
  }
  const scale = log ? Math.log10 : v => v;
  const place = v => first + (last - first) * (scale(v) - scale(low)) / (scale(high) - scale(low));
  const name = spec.label + (spec.unit ? ` (${spec.unit})` : "");
  const linearTicks = () => {
    const ticks = roundTicks(low, high, most), labels = tickLabels(ticks);
    return ticks.map((v, i) => ({ v, label: labels[i] }));
  };
  return { place, name, low, high, log, ticks: log ? logTicks(low, high, most, room) : linearTicks() };
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

// A box whose drawing follows its width.
function drawnBox(figure, data, draw) {
  const box = el("div.bars");
  const redraw = () => box.replaceChildren(draw(box.clientWidth || 700));
  data.mounts.push(() => { redraw(); new ResizeObserver(redraw).observe(box); });
  data.redraws.push(redraw);
  return box;
}

// A piece of line for the legend.
function swatch(colour, width, dash) {
  const box = svg("svg", { width: 34, height: 10, "aria-hidden": "true", class: "swatch" });
  box.append(svg("line", { x1: 0, x2: 34, y1: 5, y2: 5, stroke: colour, "stroke-width": width,
                           "stroke-dasharray": dash ? dash.join(" ") : "none" }));
  return box;
}
