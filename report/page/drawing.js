// Drawings to scale, one per angle.

function drawingFigure(figure, data) {
  const frames = figure.frames;
  const axis = figure.axis || "Shaft angle";
  const slider = el("input", { type: "range", min: 0, max: frames.length - 1, value: figure.shown, "aria-label": axis });
  slider.value = figure.shown;
  const reading = el("output.angle"), words = el("p.total", { "aria-live": "polite" });
  const chart = el("div.bars.drawing");
  const colour = look => onGround(COLOURS[figure.looks[look].colour % COLOURS.length]);
  const key = el("p.key", {}, figure.looks.map((look, k) => el("span", {}, swatch(colour(k), look.filled ? 6 : 2.6), look.label)));

  if (figure.shades) {
    const { label, unit: name, range: [low, high] } = figure.shades;
    key.append(...[0, 0.25, 0.5, 0.75, 1].map((t, k) => el("span", {}, swatch(shade(t), 10),
      (k ? "" : label + ": ") + unit(number(low + t * (high - low), 3), name))));
  }

  function update() {
    const frame = frames[Number(slider.value)];
    reading.textContent = figure.axis ? number(frame.theta_deg, 6) : degrees(frame.theta_deg);
    slider.setAttribute("aria-valuetext", reading.textContent);
    words.textContent = frame.text;
    const width = chart.clientWidth || 600;
    chart.replaceChildren(...figure.panels.map((panel, p) => drawingPanel(width, panel, frame, p, figure, colour)));
  }
  slider.addEventListener("input", update);
  data.mounts.push(() => { update(); new ResizeObserver(update).observe(chart); });
  return [el("div.slide", {}, el("label", {}, axis + " ", reading), slider), words, key, chart];
}

// A length is as long across as up.
function drawingPanel(width, panel, frame, p, figure, colour) {
  const [x0, x1] = panel.x_range, [y0, y1] = panel.y_range;
  const left = 74, right = width - 10, top = 12;
  const bottom = top + (right - left) * (y1 - y0) / (x1 - x0);
  const name = axis => axis.label + (axis.unit ? ` (${axis.unit})` : "");
  const x = plotAxis({ name: name(panel.x), from: x0, to: x1 }, [left, right]);
  const y = plotAxis({ name: name(panel.y), from: y0, to: y1 }, [bottom, top]);
  const root = svg("svg", { width, height: bottom + 44, role: "img",
                            "aria-label": `${figure.title}: ${name(panel.y)} over ${name(panel.x)}; ${frame.text}` });
  drawAxes(root, x, y, [left, right, top, bottom]);
  const inside = (v, low, high) => Math.min(high, Math.max(low, v));
  for (const line of [...list(figure.ground), ...frame.lines].filter(l => l.panel === p)) {
    const points = line.x.map((v, i) => `${inside(x.place(v), left, right).toFixed(1)},${inside(y.place(line.y[i]), top, bottom).toFixed(1)}`).join(" ");
    const filled = figure.looks[line.look].filled, shaded = figure.shades && line.value != null;
    const [low, high] = shaded ? figure.shades.range : [];
    root.append(svg("polyline", { points, stroke: colour(line.look), "stroke-width": line.width,
      fill: shaded ? shade((line.value - low) / (high - low)) : filled ? colour(line.look) : "none",
      "fill-opacity": shaded ? 1 : filled ? 0.18 : 0 }));
  }
  for (const arrow of frame.arrows.filter(a => a.panel === p)) {
    const ax = x.place(arrow.x), ay = y.place(arrow.y), bx = x.place(arrow.x + arrow.dx), by = y.place(arrow.y + arrow.dy);
    const length = Math.hypot(bx - ax, by - ay);
    if (!(length > 0)) continue;
    const size = Math.min(1, length / 18);  // the head of a short one is small too
    const ux = size * (bx - ax) / length, uy = size * (by - ay) / length;
    root.append(svg("line", { x1: ax, y1: ay, x2: bx, y2: by, stroke: colour(arrow.look), "stroke-width": 2.2 }));
    root.append(svg("polygon", { fill: colour(arrow.look), points: [[3, 0], [-7, 4], [-7, -4]]
      .map(([a, b]) => `${bx + a * ux - b * uy},${by + a * uy + b * ux}`).join(" ") }));
  }
  return root;
}
