// The place of an axis that is looked at: pointing at a plot turns the pump, turning the pump marks the plots.

let cursors = new Map();  // by the axis' label: angles have nothing to say to times

function cursorOf(label) {
  if (!cursors.has(label)) cursors.set(label, makeCursor());
  return cursors.get(label);
}

// `set` tells all followers but its source, at most once a frame, and those alone that are on the screen: the others hear of it when
// they are scrolled to. null: nothing is pointed at any more.
function makeCursor() {
  const followers = [];
  let last, from = null, asked = false;
  const onScreen = node => {
    const box = node.getBoundingClientRect();
    return box.bottom > 0 && box.top < innerHeight && box.width > 0;
  };
  function tell() {
    asked = false;
    for (const f of followers)
      if (f.source !== from && f.told !== last && f.node.isConnected && onScreen(f.node)) {
        f.told = last;
        f.show(last);
      }
  }
  function ask() {
    if (!asked && last !== undefined) setTimeout(tell, 15);
    asked = asked || last !== undefined;
  }
  addEventListener("scroll", ask, { passive: true });
  return {
    set(x, source) {
      last = x;
      from = source;
      for (const f of followers) if (f.source === source) f.told = x;
      ask();
    },
    follow: (node, source, show) => { followers.push({ node, source, show, told: undefined }); },
  };
}

// The place in `order` whose value is next to x; the values rise in that order.
function nearestPlace(values, order, x) {
  let low = 0, high = order.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[order[middle]] <= x) low = middle; else high = middle;
  }
  return Math.abs(values[order[high]] - x) < Math.abs(values[order[low]] - x) ? high : low;
}
