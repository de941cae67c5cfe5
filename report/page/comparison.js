// The comparison table: a row per group of channels, which opens into its channels.

// worst: +1 where large is bad, -1 where small is bad; the first click on a heading puts the worst on top.
const STATISTICS = [
  { key: "peak", head: "Peak", worst: 1, show: c => unit(number(c.peak), c.unit) },
  { key: "max_abs", head: "Largest difference", worst: 1, show: c => unit(small(c.max_abs), c.unit) },
  { key: "own_peak", head: "Its own", worst: 1, show: c => unit(number(c.own_peak), c.unit) },
  { key: "max_over_peak", head: "of peak", worst: 1, show: c => ratio(c.max_over_peak) },
  { key: "rms_over_peak", head: "RMS of peak", worst: 1, show: c => ratio(c.rms_over_peak) },
  { key: "theta_of_max_deg", head: "at", worst: 1, show: c => degrees(c.theta_of_max_deg) },
  { key: "digits", head: "Digits", worst: -1, show: c => (c.digits == null ? DASH : c.digits.toFixed(1)) },
];
const stateOf = c => (c.compared === false ? "not compared" : c.verdict);

// Order by one statistic (+1 largest first, -1 smallest first), what has no number last in both.
function byStatistic(items, key, direction) {
  const value = item => item[key] ?? -direction * Number.MAX_VALUE;
  return key ? [...items].sort((a, b) => direction * Math.sign(value(b) - value(a))) : items;
}

// Channels of one group; each statistic of the group is its worst channel's.
function groupChannels(channels) {
  const groups = new Map();
  for (const channel of channels) {
    const key = channel.group + "|" + channel.kind;
    if (!groups.has(key)) groups.set(key, { name: channel.group, channels: [] });
    groups.get(key).channels.push(channel);
  }
  return [...groups.values()].map(group => {
    const worst = byStatistic(group.channels, "max_over_peak", 1)[0];
    for (const { key, worst: sign } of STATISTICS) group[key] = byStatistic(group.channels, key, sign)[0][key];
    const states = group.channels.map(stateOf);
    const missing = states.filter(s => s === "not computed").length;
    return Object.assign(group, { worst, unit: worst.unit, meaning: worst.meaning,
      theta_of_max_deg: worst.theta_of_max_deg,
      state: ["incomplete", "differs", "explained"].find(s => states.includes(s)) || states.find(s => s !== "not computed") ||
        "not computed",
      missing: missing < states.length ? missing : 0 });
  });
}

// The second line of a channel: what acts on what, and the statistics that have no column.
function channelDetails(c, data) {
  const both = (values, digits) => list(values).map(v => number(v, digits)).join(" / ");
  const unless = (missing, text) => (missing ? "" : text);
  return facts([
    ["acts", phrases(c.on_body && "on " + c.on_body, c.by_body && "by " + c.by_body, c.point && "at " + c.point)],
    ["meaning", c.meaning],
    ["frame", phrases(c.frame, c.axis && "axis " + c.axis)],
    ["equation", c.equation],
    ["gap", c.gap],
    ["difference", c.nearest_to_limit ? "nearest to its limit, which changes over the turn" : ""],
    ["RMS difference", unless(c.rms == null, unit(small(c.rms), c.unit))],
    ["tolerance", unless(c.tolerance == null, small(c.tolerance) + " of peak")],
    [`mean (${data.pair.join(" / ")})`, unless(list(c.mean).every(m => m == null), unit(both(c.mean), c.unit))],
    ["difference of means", unless(c.mean_difference == null, unit(small(c.mean_difference), c.unit))],
    ...list(c.orders).map(o => ["order " + o.order,
      unit(both(o.amplitude), c.unit) + ", phase " + unit(both(o.phase_deg, 4), "deg")]),
  ].filter(([, value]) => value), ".inline");
}

function comparisonTable(channels, data, title) {
  const groups = groupChannels(channels);
  const differs = groups.some(g => ["incomplete", "differs"].includes(g.state));
  const order = differs ? { key: "max_over_peak", direction: 1 } : { key: null, direction: 1 };
  const headings = [{ key: null, head: title }, { head: "Verdict" }, ...STATISTICS];

  const statisticCells = item => STATISTICS.map(s => tableCell("td.num", s.head, s.show(item)));
  const channelRows = group => byStatistic(group.channels, order.key, order.direction).flatMap(c => [
    el("tr.channel", { role: "row" }, el("th", { scope: "row", role: "rowheader" }, el("code", {}, c.name)),
      tableCell("td", "Verdict", chip(stateOf(c))), statisticCells(c)),
    el("tr.details", { role: "row" },
      el("td", { role: "cell", colspan: headings.length }, channelDetails(c, data)))]);

  // The channels of a closed group are not built: a pump may have hundreds.
  function setOpen(group, open) {
    group.open = open;
    group.button.setAttribute("aria-expanded", open);
    group.body.replaceChildren(...(open ? channelRows(group) : []));
  }
  for (const group of groups) {
    const n = group.channels.length;
    group.button = el("button.expand", { type: "button", "aria-expanded": "false" }, group.name || DASH);
    group.button.addEventListener("click", () => setOpen(group, !group.open));
    group.head = el("tbody.group", { role: "rowgroup" }, el("tr", { role: "row" },
      el("th", { scope: "rowgroup", role: "rowheader" }, group.button, el("span.meaning-of", {}, group.meaning || ""),
        el("small", {}, n === 1 ? "1 channel" : n + " channels",
          n > 1 && group.max_over_peak != null ? [", worst ", el("code", {}, group.worst.name)] : null)),
      tableCell("td", "Verdict", chip(group.state),
        group.missing ? el("small", {}, group.missing + " not computed") : null),
      statisticCells(group)));
    group.body = el("tbody", { role: "rowgroup" });
  }

  const cells = headings.map(h => {
    const cell = el(h.worst ? "th.num" : "th", { scope: "col", role: "columnheader" });
    if (h.key === undefined) return cell.append(h.head), cell;
    const button = el("button.sort", { type: "button",
      title: h.key ? "Sort by this column, worst first; again to reverse" : "Back to the files' order" }, h.head);
    button.addEventListener("click", () => {
      order.direction = order.key === h.key ? -order.direction : h.worst || 1;
      order.key = h.key;
      arrange();
    });
    cell.append(button);
    return cell;
  });
  const grid = el("table.comparison.wide", { role: "table" },
    el("thead", { role: "rowgroup" }, el("tr", { role: "row" }, cells)));
  function arrange() {
    headings.forEach((h, i) => h.key && h.key === order.key
      ? cells[i].setAttribute("aria-sort", order.direction > 0 ? "descending" : "ascending")
      : cells[i].removeAttribute("aria-sort"));
    for (const group of byStatistic(groups, order.key, order.direction)) {
      grid.append(group.head, group.body);
      if (group.open) setOpen(group, true);
    }
  }
  arrange();
  const all = el("button.small", { type: "button" }, "Open all groups");
  all.addEventListener("click", () => {
    const open = !groups.every(g => g.open);
    groups.forEach(g => setOpen(g, open));
    all.textContent = open ? "Close all groups" : "Open all groups";
  });
  return el("div", {}, el("div.tools", {}, all), el("div.scroll", {}, grid));
}

function comparison({ channels }, data) {
  if (!list(channels).length) return null;
  const compared = channels.filter(c => c.compared !== false);
  const others = channels.filter(c => c.compared === false);
  return el("div", {},
    el("p.hint", {}, "One row per reaction, showing its worst channel. "
      + "Open a row for its channels; click a heading to sort."),
    compared.length ? comparisonTable(compared, data, "Reaction") : null,
    others.length ? el("details.others", {},
      el("summary", {}, `Columns that are not part of the verdict (${others.length})`),
      comparisonTable(others, data, "Quantity")) : null);
}
