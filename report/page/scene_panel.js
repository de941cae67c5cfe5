// The section "pump in three dimensions": slider, views, arrows by group, free-body diagrams, and the tables that say the same.

let scenePanel = null;  // of the page as it stands

function pumpInSpace(report, data, scene) {
  if (!scene || !list(scene.bodies).length) return null;
  if (scenePanel) scenePanel.dispose();
  let own, state, order;
  function take(from) {
    own = scene.curves ? prepare(report, scene.curves) : from;
    state = sceneState(scene, own);
    order = own.order.length ? own.order : Array.from({ length: scene.rows }, (_, i) => i);
  }
  take(data);
  const cursor = own.cursor;
  const both = state.models.length > 1;
  let row = order[0], body = null, mode = both ? "both" : "0", view = null, playing = null, tried = false;
  let tagged = null, length = 1;

  // ---- Groups, in the order in which the loads name them
  const groups = [];
  for (const load of scene.loads.filter(l => !l.counterpart)) {
    let group = groups.find(g => g.name === load.group);
    if (!group) groups.push(group = { name: load.group, loads: [], on: load.kind === "reaction" });
    group.loads.push(load);
  }
  // What is shown first takes the colours that differ most.
  [...groups.filter(g => g.on), ...groups.filter(g => !g.on)].forEach((g, i) => { g.colour = SCENE_COLOURS[i % SCENE_COLOURS.length]; });
  if (!groups.some(g => g.on) && groups.length) groups[0].on = true;
  const groupOf = load => groups.find(g => g.name === load.group) || { colour: "#444c55" };
  const modelsShown = () => (mode === "both" ? [0, 1] : mode === "difference" ? [0] : [Number(mode)]);
  const loadsShown = () => (body ? scene.loads.filter(l => l.on === body) : groups.filter(g => g.on).flatMap(g => g.loads));
  // Groups are scaled each by its own peak; a free body has one scale, that of its largest load at the row, so that its arrows
  // can be compared.
  const scaleOf = load => (body ? ["on " + body, scene.loads.filter(l => l.on === body)] : [load.group, groupOf(load).loads || [load]]);
  // A difference is magnified by the power of ten that brings its peak next below the peak of what it is a difference of.
  function magnification(key, loads) {
    const peak = state.peakOf(key, loads), gap = state.peakOf("difference of " + key, loads, true);
    const share = Math.max(...["force", "moment"].map(kind => (peak[kind] > 0 ? gap[kind] / peak[kind] : 0)));
    return share > 0 ? 10 ** Math.floor(-Math.log10(share)) : 1;
  }
  const peakOf = (load, kind) => {
    const [key, loads] = scaleOf(load);
    const sizes = () => loads.flatMap(l => modelsShown().map(m => state.loadAt(l, row, m)[kind])).filter(Boolean).map(lengthOf);
    const peak = body ? Math.max(0, ...sizes())
      : common.box.checked ? Math.max(0, ...groups.filter(g => g.on).map(g => state.peakOf(g.name, g.loads)[kind])) : state.peakOf(key, loads)[kind];
    return mode === "difference" ? peak / magnification(key, loads) : peak;
  };

  // ---- Controls
  const button = (text, press, attributes = {}) => {
    const made = el("button.small", { type: "button", ...attributes }, text);
    made.addEventListener("click", press);
    return made;
  };
  const slider = el("input", { type: "range", min: 0, max: order.length - 1, value: 0, "aria-label": own.axis.label });
  const reading = el("output.angle");
  const play = button("Play", () => (playing ? stop() : start()), { "aria-pressed": "false" });
  const speed = el("select", { "aria-label": "Speed" }, ["1/8", "1/4", "1/2", "1", "2"].map((s, i) =>
    el("option", { value: [0.125, 0.25, 0.5, 1, 2][i], selected: i === 1 }, `speed ${s}`)));
  const chooser = (legend, choices, chosen, choose) => {
    const buttons = choices.map(([value, text]) => button(text, () => { mark(value); choose(value); }, { "data-value": value }));
    const mark = value => buttons.forEach(b => b.setAttribute("aria-pressed", String(b.dataset.value === value)));
    mark(chosen);
    return { node: el("div.choice", { role: "group", "aria-label": legend }, el("span", {}, legend), buttons), mark };
  };
  const views = chooser("View", [["side", "side"], ["front", "front of the block"], ["free", "free"]], "free", v => view && view.setView(v));
  const modelChoice = chooser("Model", [...state.models.map((m, i) => [String(i), m]), ...(both ? [["both", "both"], ["difference", "difference"]] : [])],
    mode, v => { mode = v; update(); });
  const check = (text, change) => {
    const box = el("input", { type: "checkbox" });
    box.addEventListener("change", () => change(box.checked));
    return { box, node: el("label.check", {}, box, " " + text) };
  };
  const cutting = check("section", on => view && view.cut(on)), names = check("names", () => update()), common = check("one scale", () => update());
  names.box.checked = true;
  const lengths = el("input", { type: "range", min: -1, max: 1.5, step: 0.05, value: 0, "aria-label": "Length of the arrows" });
  lengths.addEventListener("input", () => { length = 10 ** Number(lengths.value); update(); });
  const legend = el("div.legend", { role: "group", "aria-label": "Arrows" });
  const legendRows = groups.map(g => {
    const box = el("input", { type: "checkbox" }), size = el("span.peak");
    box.checked = g.on;
    box.addEventListener("change", () => { g.on = box.checked; update(); });
    legend.append(el("label.check", {}, box, swatch(onGround(g.colour), 5), el("b", {}, g.name), size));
    return { g, box, size };
  });
  const bodyChoice = chooser("Free body", [["", "whole pump"], ...scene.bodies.filter(b => scene.loads.some(l => l.on === b.name)).map(b => [b.name, b.name])],
    "", v => select(v || null));

  // ---- What is seen
  const canvas = el("canvas", { tabindex: 0, role: "img", "aria-label": "The pump in three dimensions; the numbers are in the tables below" });
  const tags = el("div.tags", { "aria-hidden": "true" }), tip = el("div.tip", { role: "status", hidden: true });
  const frame = el("div.space", {}, canvas, tags, tip);
  const words = el("p.total", { "aria-live": "polite" }), scaleWords = el("p.hint"), sums = el("div");
  const numbers = el("details", {}, el("summary", {}, "Numbers of the arrows, components in S1"), el("div"));
  const stills = el("div.stills", { "aria-hidden": "true" });
  let film = filmInset(state);
  numbers.addEventListener("toggle", () => update());

  function largest() {
    const chosen = body ? [...new Set(loadsShown().map(l => l.group))].map(name => ({ name, loads: loadsShown().filter(l => l.group === name) }))
      : groups.filter(g => g.on);
    return largestWords(state, chosen, row, modelsShown());
  }
  const [, axisName, axisUnit] = /^(.*?)(?: \(([^()]*)\))?$/.exec(own.axis.label);  // "time (ms)"
  const placeText = () => (own.axis.angle ? degrees(own.theta[row])
    : own.theta.length ? `${axisName} ${unit(number(own.theta[row]), axisUnit)}` : "");
  function update() {
    slider.value = order.indexOf(row);
    reading.textContent = placeText();
    slider.setAttribute("aria-valuetext", reading.textContent);
    for (const { g, box, size } of legendRows) {
      const peak = state.peakOf(g.name, g.loads);
      size.textContent = [peak.force > 0 ? kilo(peak.force, "N") : null, peak.moment > 0 ? kilo(peak.moment, "Nm") : null].filter(Boolean).join(", ") || "0";
      if (mode === "difference") size.textContent += `, \u00d7 ${number(magnification(g.name, g.loads))}`;
      box.disabled = !!body;
    }
    scaleWords.textContent = (body ? "One scale for all forces on this body, one for all moments: the longest arrow is the largest of them at this place."
      : common.box.checked ? "One scale for all forces and one for all moments: the longest arrow is the largest peak of those shown."
      : "Each kind has a scale of its own: its longest arrow is its peak over the rows of this view, as given beside its name.")
      + (length !== 1 ? ` Times ${number(length, 3)}.` : "") + " Pale and hollow: drawn longer than it is, to be seen. A dot: zero."
      + (mode === "both" ? ` Wide and pale: ${state.models[0]}; narrow: ${state.models[1]}.` : "")
      + (mode === "difference" ? ` ${state.models[1]} minus ${state.models[0]}, magnified ${body ? number(magnification(...scaleOf({}))) + " times" : "as said beside each name"};`
        + " no arrow where the page's digits do not resolve it." : "");
    if (!playing) {
      words.textContent = `At ${placeText()}: ${largest()}`;
      if (numbers.open) numbers.lastElementChild.replaceChildren(loadsTable(state, loadsShown(), row, mode === "difference" ? [0, 1] : modelsShown()));
    }
    sums.replaceChildren(...(body ? [sumsTable(state, body, row)] : []));
    if (film) film.show(row, mode === "1" ? 1 : 0);
    if (view) view.show({ loads: loadsShown(), models: modelsShown(), difference: mode === "difference", body, length }, row);
  }
  // Where the name of an arrow can stand about its tip, the nearest first.
  function tagPlaces(wide) {
    const near = [[4, -9], [-wide - 4, -9], [4, 8], [-wide - 4, 8], [-wide / 2, -26], [-wide / 2, 14], [10, -26], [-wide - 10, -26], [10, 24], [-wide - 10, 24]];
    const far = [];
    for (let away = 34; away <= 400; away += 17)
      for (let k = 0; k < 16; ++k) far.push([away * Math.cos(k * Math.PI / 8) - wide / 2, away * Math.sin(k * Math.PI / 8) - 7]);
    return [...near, ...far];
  }
  // Names at the tips: first one of each group, the largest first; beside the tip where there is room, else around it, further
  // away with a line to it.
  function drawTags() {
    if (!view || !(names.box.checked || body)) return tags.replaceChildren();
    const each = key => { const seen = new Set(); return t => !seen.has(t[key]) && seen.add(t[key]); };
    const tips = view.tips().filter(t => !t.none).sort((a, b) => b.share - a.share).filter(each("label"));  // of both models one
    const first = tips.filter(each("group")), later = tips.filter(t => !first.includes(t));
    const boxes = [], made = [], leads = svg("svg", { width: "100%", height: "100%" });
    for (const { label, colour, at: [x, y] } of [...first, ...later]) {
      const wide = 9 * label.length + 10, high = 16;
      const place = tagPlaces(wide).map(([dx, dy]) => [x + dx, y + dy]).find(([l, t]) => l > 0 && t > 0 && l + wide < canvas.clientWidth && t + high < canvas.clientHeight
        && boxes.every(([bl, bt, bw]) => l > bl + bw || bl > l + wide || Math.abs(t - bt) > high));
      if (!place) continue;
      boxes.push([...place, wide]);
      const toX = Math.min(Math.max(x, place[0]), place[0] + wide), toY = Math.min(Math.max(y, place[1]), place[1] + high);
      if (Math.hypot(toX - x, toY - y) > 24)
        leads.append(svg("line", { x1: x, y1: y, x2: toX, y2: toY, stroke: colour, "stroke-width": 1, "stroke-opacity": 0.7 }));
      const tag = el("span", {}, label);
      tag.style.color = colour;
      tag.style.transform = `translate(${place[0].toFixed(1)}px, ${place[1].toFixed(1)}px)`;
      made.push(tag);
    }
    tags.replaceChildren(leads, ...made);
  }
  function setRow(i, from) {
    row = Math.min(Math.max(0, Math.round(i)), state.rows - 1);
    update();
    if (from !== cursor && own.theta.length) cursor.set(own.theta[row], panel);
  }
  function select(name) {
    body = name;
    numbers.open = numbers.open || !!name;
    bodyChoice.mark(name || "");
    update();
  }

  // ---- Playing: a turn in a second at speed 1; a run over time, whole, in ten
  function start() {
    let last = null, at = order.indexOf(row);
    const rate = own.axis.angle ? 360 / own.step : order.length / 10;
    const step = now => {
      if (!frame.isConnected) return stop();
      if (last != null) {
        at = (at + Math.min(0.2, (now - last) / 1e3) * rate * Number(speed.value)) % order.length;
        setRow(order[Math.floor(at)]);
      }
      last = now;
      playing = requestAnimationFrame(step);
    };
    playing = requestAnimationFrame(step);
    play.setAttribute("aria-pressed", "true");
    play.textContent = "Pause";
  }
  function stop() {
    cancelAnimationFrame(playing);
    playing = null;
    play.setAttribute("aria-pressed", "false");
    play.textContent = "Play";
    update();
  }

  // ---- The picture, made when it comes near the screen
  function showStill() {
    const still = document.querySelector("#picture svg");
    frame.classList.add("flat");
    frame.replaceChildren(el("p.empty", {}, "This browser draws no WebGL here, so the pump is shown as still pictures; "
      + "slider and tables work all the same."), ...(still ? [el("div.scroll.pump")] : []));
    if (still) frame.lastElementChild.append(still.cloneNode(true));
  }
  function open() {
    if (tried) return;
    tried = true;
    try {
      view = sceneView(state, canvas, { colour: name => groupOf({ group: name }).colour, peak: peakOf, drawn: drawTags });
    } catch (error) {
      console.warn(error);
    }
    if (!view) {
      showStill();
      [views.node, cutting.node, names.node, common.node, speed, play, lengths.parentElement].forEach(n => n && (n.hidden = true));
      return;
    }
    const fit = () => {
      const width = frame.clientWidth;
      if (!width) return;
      const height = Math.round(Math.min(700, Math.max(280, 0.85 * width)));
      canvas.style.height = height + "px";
      view.resize(width, height);
    };
    fit();
    new ResizeObserver(fit).observe(frame);
    listen();
    update();
  }
  function listen() {
    let pressed = null;
    const placeOf = e => {
      const box = canvas.getBoundingClientRect();
      return [e.clientX - box.left, e.clientY - box.top];
    };
    function readOut(e) {
      const [x, y] = placeOf(e), found = view.arrowNear(x, y);
      tip.hidden = !found;
      if (!found) return null;
      tip.replaceChildren(...loadWords(state, found, mode === "difference").map(line => el("div", {}, line)));
      tip.style.left = Math.max(0, Math.min(x + 14, canvas.clientWidth - tip.offsetWidth - 4)) + "px";
      tip.style.top = Math.max(0, Math.min(y + 14, canvas.clientHeight - tip.offsetHeight - 4)) + "px";
      return found;
    }
    // A page is scrolled over the picture until this is clicked: then wheel and finger are its own.
    const pass = e => { if (document.activeElement !== canvas) e.stopPropagation(); };
    for (const type of ["wheel", "touchstart"]) frame.addEventListener(type, pass, { capture: true, passive: true });
    canvas.addEventListener("pointermove", e => { if (!e.buttons) readOut(e); });
    canvas.addEventListener("pointerleave", () => { tip.hidden = true; });
    canvas.addEventListener("pointerdown", e => { pressed = placeOf(e); });
    canvas.addEventListener("click", e => {
      const [x, y] = placeOf(e);
      canvas.focus({ preventScroll: true });
      if (pressed && Math.hypot(x - pressed[0], y - pressed[1]) > 5) return;
      if (readOut(e)) return;
      const name = view.bodyNear(x, y);
      if (body) { if (!name) select(null); } else if (scene.loads.some(l => l.on === name)) select(name);
    });
    const keys = {
      ArrowLeft: () => view.orbit(-0.1, 0), ArrowRight: () => view.orbit(0.1, 0), ArrowUp: () => view.orbit(0, -0.1), ArrowDown: () => view.orbit(0, 0.1),
      "+": () => view.zoom(1.2), "-": () => view.zoom(1 / 1.2), ",": () => step(-1), ".": () => step(1), " ": () => play.click(),
      Escape: () => select(null),
    };
    const step = by => setRow(order[(order.indexOf(row) + by + order.length) % order.length]);
    canvas.addEventListener("keydown", e => {
      if (!keys[e.key] || e.ctrlKey || e.metaKey || e.altKey) return;
      e.preventDefault();
      keys[e.key]();
    });
  }
  slider.addEventListener("input", () => setRow(order[Number(slider.value)]));

  // ---- Paper
  function print() {
    open();
    if (!view) return;
    stills.replaceChildren(...["side", "front", "free"].map(name =>
      el("div", {}, view.still(name, 640, 420), el("p", {}, { side: "side", front: "front of the block", free: "free" }[name]))));
  }
  addEventListener("beforeprint", print);

  const zooms = el("span.choice", {}, button("+", () => view && view.zoom(1.2), { "aria-label": "Closer" }),
    button("\u2212", () => view && view.zoom(1 / 1.2), { "aria-label": "Further away" }));
  const node = el("div.in-space", {},
    el("div.slide", {}, play, el("label", {}, own.axis.angle ? "Shaft angle " : "", reading), slider, speed),
    el("div.choices", {}, views.node, zooms, cutting.node, names.node, common.node, modelChoice.node),
    el("div.beside", {}, el("div", {}, frame, stills), el("div", {}, legend,
      el("label.lengths", {}, "Length of the arrows ", lengths), film ? film.node : null)),
    scaleWords, words, bodyChoice.node, sums, numbers,
    el("p.hint", {}, "Drag to turn it, with the right button to move it; the wheel zooms once it is clicked. Point at an arrow for its number, "
      + "click a body for its free-body diagram. Keys: arrows turn, + and \u2212 zoom, comma and full stop step, space plays, Esc shows all."),
    scene.note ? el("p.note", {}, scene.note) : null);
  const panel = {
    node,
    // Draws another pump in the same picture. Not so where it has other bodies or loads: then it is made anew.
    change(next, from) {
      const parts = s => JSON.stringify([s.models, s.rows, s.bodies.map(b => b.name), s.loads.map(l => [l.id, l.group]), !!s.film_point]);
      if (parts(next) !== parts(scene)) return false;
      scene = next;
      take(from);
      for (const g of groups) g.loads = scene.loads.filter(l => !l.counterpart && l.group === g.name);
      if (film) {
        const before = film.node;
        film = filmInset(state);
        before.replaceWith(film.node);
      }
      if (view) view.change(state); else if (tried) showStill();
      update();
      return true;
    },
    dispose() {
      removeEventListener("beforeprint", print);
      if (playing) cancelAnimationFrame(playing);
      if (view) view.dispose();
    },
  };
  scenePanel = panel;
  cursor.follow(node, panel, x => { if (x != null && own.order.length) setRow(order[nearestPlace(own.theta, order, x)], cursor); });
  data.mounts.push(() => {
    const near = new IntersectionObserver(entries => {
      if (entries.some(e => e.isIntersecting)) { near.disconnect(); open(); }
    }, { rootMargin: "400px" });
    near.observe(frame);
    update();
  });

  // For tests and scripts: docs/view.md.
  window.bentaxisScene = {
    rows: state.rows, row: () => row, webgl: () => { open(); return !!view; }, setRow: i => { open(); setRow(i); },
    groups: () => groups.map(g => g.name),
    show(wanted) {
      open();
      for (const { g, box } of legendRows) box.checked = g.on = wanted === true || list(wanted).includes(g.name);
      update();
    },
    select: name => { open(); select(name); }, model: name => { open(); modelChoice.node.querySelector(`[data-value="${name}"]`).click(); },
    view: name => { open(); views.node.querySelector(`[data-value="${name}"]`).click(); },
    cut: on => { open(); cutting.box.checked = on; if (view) view.cut(on); },
    state: () => { open(); return { row, ...(view ? view.asDrawn() : { bodies: [], arrows: [] }) }; },
    sumOf: name => state.models.map((_, m) => state.sumOf(name, row, m)),
    still: (name, width, height) => { open(); return view && view.still(name, width, height); },
    frames: () => (view ? view.frames() : 0), drawNow: () => view && view.draw(),
  };
  return node;
}
