// The pump in space, from the numbers of the block "scene": where bodies stand, where forces act and how large they are
// at a row. Draws nothing. Every place and vector is a sum of fixed axes times numbers (report/scene.h).

const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, f) => [a[0] * f, a[1] * f, a[2] * f];
const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const outer = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const lengthOf = a => Math.sqrt(inner(a, a));
const NOWHERE = { origin: [0, 0, 0], axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] };  // S1
const NOTHING = 1e-9;  // of a peak: less is round-off, and said and drawn as zero

function floatsOf(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 4 }, (_, i) => view.getFloat32(4 * i, true));
}

// `data` is what prepare() makes of the page's curves, or of the scene's own.
function sceneState(scene, data) {
  const series = list(scene.series).map(floatsOf);
  const models = list(scene.models);
  const tables = models.map(name => data.tables.find(t => t.name === name) || data.tables[0] || { columns: {} });
  const bodies = new Map(scene.bodies.map(b => [b.name, b]));

  // NaN where it was not computed.
  function valueOf(scalar, row, model) {
    if (typeof scalar === "number") return scalar;
    const [constant, factor, of] = scalar;
    if (typeof of === "number") return constant + factor * series[of][row];
    const values = of === "theta_deg" ? data.theta : tables[model].columns[of];
    const value = values ? values[row] : null;
    return value == null ? NaN : constant + factor * value;
  }
  function vectorOf(terms, row, model) {
    const sum = [0, 0, 0];
    for (const [x, y, z, scalar] of terms) {
      const value = valueOf(scalar, row, model);
      sum[0] += x * value; sum[1] += y * value; sum[2] += z * value;
    }
    return sum;
  }
  // Second model minus first. Channels have the page's differences, taken before rounding; series are 32-bit floats, whose
  // difference says nothing below their own digits: then null.
  function differenceOf(both, row) {
    const [first, second] = both;
    const sameTerms = first.length === second.length && first.every((t, i) => {
      const other = second[i];
      return [0, 1, 2].every(k => t[k] === other[k]) && JSON.stringify(t[3]) === JSON.stringify(other[3]);
    });
    const exact = terms => terms.every(t => typeof t[3] === "number" || t[3][2] === "theta_deg"
      || (typeof t[3][2] === "string" && data.difference[t[3][2]]));
    if (sameTerms && exact(first)) {
      const sum = [0, 0, 0];
      for (const [x, y, z, scalar] of first) {
        if (typeof scalar === "number" || scalar[2] === "theta_deg") continue;
        const d = data.difference[scalar[2]][row];
        const value = d == null ? NaN : scalar[1] * d;
        sum[0] += x * value; sum[1] += y * value; sum[2] += z * value;
      }
      return sum;
    }
    const a = vectorOf(first, row, 0), b = vectorOf(second, row, 1), gap = minus(b, a);
    return lengthOf(gap) > 2e-6 * (lengthOf(a) + lengthOf(b)) ? gap : null;
  }

  // One alone stands for all models.
  const ofModel = (parts, model) => parts[Math.min(model, parts.length - 1)];

  const inFrame = (frame, v) => plus(frame.origin, plus(times(frame.axes[0], v[0]),
    plus(times(frame.axes[1], v[1]), times(frame.axes[2], v[2]))));
  // Origin and axes of a body in S1. One that stands between two points has no angle of its own about their line: its x axis
  // is S1's, made normal to that line. The first model says how bodies stand.
  function bodyAt(name, row) {
    const body = bodies.get(name);
    if (!body) return NOWHERE;
    const fixed = { origin: body.origin || [0, 0, 0], axes: body.axes || NOWHERE.axes };
    if (body.turns != null) {
      const angle = valueOf(body.turns, row, 0), c = Math.cos(angle), s = Math.sin(angle), [x, y, z] = fixed.axes;
      return { origin: fixed.origin, axes: [plus(times(x, c), times(y, s)), plus(times(x, -s), times(y, c)), z] };
    }
    if (body.from) {
      const from = placeAt(body.from, row), along = minus(placeAt(body.to, row), from);
      const z = times(along, 1 / lengthOf(along));
      const across = minus([1, 0, 0], times(z, z[0])), x = times(across, 1 / lengthOf(across));
      return { origin: from, axes: [x, outer(z, x), z] };
    }
    return fixed;
  }
  function placeAt(place, row, model = 0) {
    const at = vectorOf(place.at, row, model);
    return place.body ? inFrame(bodyAt(place.body, row), at) : at;
  }

  // What a load is in a model: null where it has no force (moment), the model lacks it, or it was not computed.
  const partAt = (part, row, model) => {
    const terms = list(part).length ? ofModel(part, model) : [];
    if (!terms.length) return null;
    const v = vectorOf(terms, row, model);
    return v.every(Number.isFinite) ? v : null;
  };
  const loadAt = (load, row, model) => ({ at: placeAt(ofModel(load.at, model), row, model), force: partAt(load.force, row, model),
                                          moment: partAt(load.moment, row, model) });
  const gapOf = (part, row) => {
    const both = list(part).length && models.length > 1 ? [0, 1].map(m => ofModel(part, m)) : [];
    return both.length && both.every(v => v.length) ? differenceOf(both, row) : null;
  };
  const differenceAt = (load, row) => ({ at: placeAt(load.at[0], row, 0), force: gapOf(load.force, row), moment: gapOf(load.moment, row) });

  // What is left of all loads on a body; moments about the first load's point.
  function sumOf(name, row, model) {
    const found = scene.loads.filter(l => l.on === name).map(l => loadAt(l, row, model));
    const sum = { force: [0, 0, 0], moment: [0, 0, 0], forces: 0, moments: 0 };
    for (const { at, force, moment } of found) {
      if (force) {
        const lever = minus(at, found[0].at);
        sum.force = plus(sum.force, force);
        sum.moment = plus(sum.moment, outer(lever, force));
        sum.forces += lengthOf(force);
        sum.moments += lengthOf(lever) * lengthOf(force);
      }
      if (moment) {
        sum.moment = plus(sum.moment, moment);
        sum.moments += lengthOf(moment);
      }
    }
    return { ...sum, force_over_sum: sum.forces ? lengthOf(sum.force) / sum.forces : 0,
             moment_over_sum: sum.moments ? lengthOf(sum.moment) / sum.moments : 0 };
  }

  // The largest force and moment over all rows (and models, or of their difference), of some loads; found once per key.
  const peaks = new Map();
  function peakOf(key, loads, ofDifference = false) {
    if (peaks.has(key)) return peaks.get(key);
    const peak = { force: 0, moment: 0 };
    for (const load of loads)
      for (const part of ["force", "moment"])
        for (let model = 0; model < (ofDifference ? 1 : models.length); ++model)
          for (let row = 0; list(load[part]).length && row < scene.rows; ++row) {
            const v = ofDifference ? gapOf(load[part], row) : partAt(load[part], row, model);
            if (v && v.every(Number.isFinite)) peak[part] = Math.max(peak[part], lengthOf(v));
          }
    peaks.set(key, peak);
    return peak;
  }

  // Components in the frame in which a load is read out.
  const frames = new Map(list(scene.frames).map(f => [f.name, f.axes]));
  const componentsOf = (load, v) => (frames.get(load.frame) || NOWHERE.axes).map(axis => inner(axis, v));

  return { scene, data, rows: scene.rows, models, bodies, valueOf, vectorOf, bodyAt, placeAt, loadAt, differenceAt, sumOf, peakOf, componentsOf };
}
