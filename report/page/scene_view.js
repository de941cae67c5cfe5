// The picture of the pump in space: camera, light, section cut, arrows, pointing. Draws only when something has changed.

const SHORTEST = 0.03;  // of the longest arrow: shorter ones are drawn this long, and marked

// Views stand on the first two frames of the scene, the fixed one and that of the tilted block: the first from the side, its z
// to the right; the second against its z, its x to the right; both with y up.
const VIEWS = {
  side: frames => ({ from: times(frames[0].axes[0], -1), up: frames[0].axes[1] }),
  front: frames => ({ from: (frames[1] || frames[0]).axes[2], up: (frames[1] || frames[0]).axes[1] }),
  free: frames => ({ from: plus(times(frames[0].axes[0], -1), plus(times(frames[0].axes[1], 0.55), times(frames[0].axes[2], -0.75))),
                     up: frames[0].axes[1] }),
};

// null where there is no WebGL.
function makeRenderer(canvas) {
  const context = canvas.getContext("webgl", { alpha: true, antialias: true, stencil: false })
    || canvas.getContext("experimental-webgl");
  if (!context) return null;
  const renderer = new THREE.WebGLRenderer({ canvas, context, alpha: true, antialias: true });
  renderer.localClippingEnabled = true;
  renderer.autoClear = false;
  renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
  return renderer;
}

function sceneView(state, canvas, look) {
  const renderer = makeRenderer(canvas);
  if (!renderer) return null;
  let scene, frames, bodies, thickness, longest, centre;
  const solids = new THREE.Scene(), forces = new THREE.Scene();  // arrows are drawn over the bodies, not inside them
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 10);
  const sun = new THREE.DirectionalLight("#ffffff", 0.62);
  for (const [i, s] of [solids, forces].entries()) s.add(new THREE.AmbientLight("#ffffff", i ? 0.75 : 0.5));
  solids.add(sun, sun.target);
  const planes = [];  // those of the section cut; the materials share this list
  function build() {
    scene = state.scene;
    frames = list(scene.frames).length ? scene.frames : [{ axes: NOWHERE.axes }];
    bodies = new Map(scene.bodies.map(b => [b.name, bodyObject(b, planes)]));
    bodies.forEach(b => solids.add(b));
    thickness = 0.011 * scene.radius;
    longest = 0.75 * scene.radius;
    centre = scene.centre || [0, 0, 0];
  }
  build();
  const arrows = new Map();  // by load, model and part
  let clear = [];  // looks that are seen through beside those that always are: the plate, before the block
  let row = 0, drawn = 0, asked = false, gone = false;
  let fitted = null, sizes = null;  // of the bodies as a view sees them, and of the canvas in px
  let shown = { loads: [], models: [0], difference: false, body: null, length: 1 };

  // ---- Camera
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;
  controls.screenSpacePanning = true;
  controls.minZoom = 0.4;
  controls.maxZoom = 40;
  controls.addEventListener("change", () => invalidate());
  function setView(name) {
    const { from, up } = VIEWS[name](frames);
    controls.target.set(...centre);
    camera.up.set(0, 1, 0);
    camera.position.set(...plus(centre, times(from, 4 * scene.radius / lengthOf(from))));
    if (Math.abs(inner(up, [0, 1, 0])) < 1e-6) camera.up.set(...up);
    clear = name === "front" ? ["plate", "delivery", "suction"] : [];
    dress();
    camera.zoom = 1;
    camera.near = 0.1 * scene.radius;
    camera.far = 8 * scene.radius;
    camera.updateProjectionMatrix();
    controls.update();
    fitted = extent();
    if (sizes) resize(...sizes);
    // Its middle in the middle.
    const move = new THREE.Vector3(fitted.middle.x, fitted.middle.y, 0).applyQuaternion(camera.quaternion);
    controls.target.add(move);
    camera.position.add(move);
    controls.update();
    invalidate();
  }
  function orbit(across, down) {
    const away = camera.position.clone().sub(controls.target), at = new THREE.Spherical().setFromVector3(away);
    at.theta += across;
    at.phi += down;
    at.makeSafe();
    camera.position.copy(controls.target).add(away.setFromSpherical(at));
    controls.update();
    invalidate();
  }
  function zoom(factor) {
    camera.zoom = Math.min(controls.maxZoom, Math.max(controls.minZoom, camera.zoom * factor));
    camera.updateProjectionMatrix();
    invalidate();
  }
  // Half of what the bodies take across and up, as the camera sees them, and where their middle is.
  function extent() {
    const box = new THREE.Box3();
    camera.updateMatrixWorld();
    const inverse = new THREE.Matrix4().getInverse(camera.matrixWorld);
    solids.updateMatrixWorld(true);
    bodies.forEach(b => b.traverse(part => {
      if (!part.geometry || !part.visible) return;
      const place = part.geometry.attributes.position;
      for (let i = 0; i < place.count; ++i) box.expandByPoint(new THREE.Vector3().fromBufferAttribute(place, i).applyMatrix4(part.matrixWorld).applyMatrix4(inverse));
    }));
    const size = box.getSize(new THREE.Vector3());
    return { across: size.x / 2, up: size.y / 2, middle: box.getCenter(new THREE.Vector3()) };
  }
  function resize(width, height) {
    const wide = width / height;
    camera.top = fitted ? 1.25 * Math.max(fitted.up, fitted.across / wide) : 1.02 * scene.radius * Math.max(1, 1 / wide);
    sizes = [width, height];
    camera.right = camera.top * wide;
    camera.bottom = -camera.top;
    camera.left = -camera.right;
    camera.updateProjectionMatrix();
    renderer.setSize(width, height, false);
    invalidate();
  }

  // ---- What is shown
  const colourOf = load => onGround(look.colour(load.group));
  // Every arrow that is to be seen now: a load, a model (or the difference), a force or a moment.
  function parts() {
    const found = [];
    for (const load of shown.loads)
      for (const model of shown.difference ? [0] : shown.models) {
        const at = shown.difference ? state.differenceAt(load, row) : state.loadAt(load, row, model);
        for (const kind of ["force", "moment"])
          if (at[kind] && at[kind].every(Number.isFinite)) found.push({ load, model, kind, at: at.at, v: at[kind] });
      }
    return found;
  }
  function place() {
    bodies.forEach((object, name) => {
      placeBody(object, state.bodyAt(name, row), scalar => state.valueOf(scalar, row, 0));
      object.visible = !shown.body || shown.body === name;
    });
    arrows.forEach(a => { a.visible = false; });
    for (const { load, model, kind, at, v } of parts()) {
      const pale = !shown.difference && shown.models.length > 1 && model === 0, key = [load.id, model, kind, pale].join();
      if (!arrows.has(key)) {
        const made = arrowObject(colourOf(load), kind === "moment" ? 2 : 1, thickness * (pale ? 2.1 : 1), pale);
        made.userData.of = { id: load.id, model, kind };
        arrows.set(key, made);
        forces.add(made);
      }
      const object = arrows.get(key), peak = look.peak(load, kind), share = peak > 0 ? lengthOf(v) / peak : 0;
      const none = share < NOTHING, least = !none && share * shown.length < SHORTEST;
      object.visible = true;
      setArrow(object, at, none ? [0, 0, 0] : v, longest * Math.max(SHORTEST, share * shown.length), least);
      object.userData.now = { load, v, least, none, newtonsPerMetre: peak / (longest * shown.length) };
    }
  }

  // Another pump with the same bodies and loads in the same picture: camera, section and what is shown stay.
  function change(next) {
    bodies.forEach(body => {
      solids.remove(body);
      body.traverse(part => [part.geometry, part.material].forEach(kept => kept && kept.dispose()));
    });
    state = next;
    build();
    dress();
    place();
    invalidate();
  }

  // ---- Drawing
  function invalidate() {
    if (asked || gone) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; if (!gone) draw(); });
  }
  function draw() {
    camera.updateMatrixWorld();
    sun.position.copy(camera.position).add(new THREE.Vector3(-0.4, 0.9, 0.25).applyQuaternion(camera.quaternion).multiplyScalar(2 * scene.radius));
    sun.target.position.copy(controls.target);
    sun.target.updateMatrixWorld();
    renderer.clear();
    renderer.render(solids, camera);
    renderer.clearDepth();
    renderer.render(forces, camera);
    ++drawn;
    look.drawn();
  }
  function show(changed, at = row) {
    shown = { ...shown, ...changed };
    row = at;
    place();
    invalidate();
  }
  function dress() {
    const on = planes.length > 0;
    bodies.forEach(b => b.userData.shapes.forEach(({ userData: u }) => {
      if (!u.faces) return;
      u.inside.visible = on && u.cut;
      const through = u.seeThrough && !on || clear.includes(u.look);
      Object.assign(u.faces.material, { transparent: through, opacity: through ? 0.28 : 1, depthWrite: !through, needsUpdate: true });
    }));
  }
  function cut(on) {
    planes.length = 0;
    if (on) planes.push(new THREE.Plane(new THREE.Vector3(...frames[0].axes[0]), 0));
    dress();
    invalidate();
  }

  // ---- Pointing. Places in px of the canvas.
  function onCanvas(point) {
    const p = new THREE.Vector3(...point).project(camera);
    return [(p.x + 1) / 2 * canvas.clientWidth, (1 - p.y) / 2 * canvas.clientHeight];
  }
  const seen = () => [...arrows.values()].filter(a => a.visible);
  function arrowNear(x, y) {
    let best = null, least = 10;
    for (const arrow of seen()) {
      const { tail, drawn: v } = arrowAsDrawn(arrow), [ax, ay] = onCanvas(tail), [bx, by] = onCanvas(plus(tail, v));
      const dx = bx - ax, dy = by - ay, size = dx * dx + dy * dy;
      const along = size ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / size)) : 0;
      const far = Math.hypot(x - ax - along * dx, y - ay - along * dy);
      if (far < least) { least = far; best = arrow; }
    }
    return best && { ...best.userData.of, ...best.userData.now };
  }
  // The body under a place: a see-through one only where there is nothing behind it.
  function bodyNear(x, y) {
    const ray = new THREE.Raycaster();
    ray.setFromCamera({ x: 2 * x / canvas.clientWidth - 1, y: 1 - 2 * y / canvas.clientHeight }, camera);
    const hits = [...bodies].filter(([, b]) => b.visible).flatMap(([name, b]) => b.userData.shapes.filter(s => s.userData.faces)
      .flatMap(s => ray.intersectObject(s.userData.faces).map(hit => ({ name, hit, clear: s.userData.faces.material.transparent,
        away: s.userData.cut && planes.some(p => p.distanceToPoint(hit.point) < 0) }))))
      .filter(h => !h.away).sort((a, b) => a.hit.distance - b.hit.distance);
    const solid = hits.find(h => !h.clear) || hits[0];
    return solid ? solid.name : null;
  }
  const nameOf = load => load.symbol || load.id;
  const tips = () => seen().map(a => {
    const { tail, drawn: v } = arrowAsDrawn(a);
    return { ...a.userData.of, label: nameOf(a.userData.now.load), group: a.userData.now.load.group,
      colour: colourOf(a.userData.now.load), share: lengthOf(v), none: a.userData.now.none, at: onCanvas(plus(tail, v)) };
  });

  // What the objects themselves say, for tests.
  function asDrawn() {
    const vector = m => [0, 4, 8].map(i => m.elements.slice(i, i + 3));
    return {
      bodies: [...bodies].map(([name, b]) => {
        b.updateMatrixWorld(true);
        return { name, visible: b.visible, origin: [...b.matrixWorld.elements.slice(12, 15)], axes: vector(b.matrixWorld) };
      }),
      arrows: seen().map(a => {
        const { tail, drawn: v } = arrowAsDrawn(a), { newtonsPerMetre, least, none, v: value } = a.userData.now;
        // One at least length says its direction alone.
        const scale = none ? 0 : least ? lengthOf(value) / lengthOf(v) : newtonsPerMetre;
        return { ...a.userData.of, label: nameOf(a.userData.now.load), tail, drawn: v, vector: times(v, scale), least, none };
      }),
    };
  }

  // A still picture of a view, as canvas: for paper.
  function still(view, width, height) {
    const before = { position: camera.position.clone(), target: controls.target.clone(), zoom: camera.zoom, up: camera.up.clone(), fitted };
    const size = [canvas.clientWidth || width, canvas.clientHeight || height];
    setView(view);
    renderer.setClearColor("#ffffff", 1);
    resize(width, height);
    draw();
    const copy = el("canvas", { width: canvas.width, height: canvas.height, role: "img", "aria-label": `The pump, ${view} view` });
    copy.getContext("2d").drawImage(canvas, 0, 0);
    camera.position.copy(before.position);
    camera.up.copy(before.up);
    controls.target.copy(before.target);
    camera.zoom = before.zoom;
    fitted = before.fitted;
    renderer.setClearColor("#000000", 0);
    resize(...size);
    controls.update();
    draw();
    return copy;
  }
  function dispose() {
    gone = true;
    controls.dispose();
    renderer.dispose();
    renderer.forceContextLoss();
  }

  place();
  setView("free");
  return { show, change, setView, orbit, zoom, resize, cut, arrowNear, bodyNear, tips, asDrawn, still, dispose, draw, frames: () => drawn };
}
