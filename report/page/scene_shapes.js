// Bodies and arrows of the pump in space as objects of three.js.

const LOOKS = { shaft: "#8fa0b0", piston: "#d5dbe1", block: "#c8b078", plate: "#9aa3ab", delivery: "#d55e00", suction: "#0072b2",
                gear: "#a89a86", bearing: "#6d7b88", pin: "#55606b", axis: "#67727e" };
const REST = "#9ecbe8", PRESSURE = "#d55e00";  // ends of the tint

// ---- Shapes

// Triangles of a profile (r, z) turned about z, outside seen counter-clockwise. Where the profile bends by less than 40
// degrees it is shaded as round.
function latheGeometry(profile) {
  const around = 48, points = profile.filter((p, i) => !i || p[0] !== profile[i - 1][0] || p[1] !== profile[i - 1][1]);
  let area = 0;
  points.forEach(([r, z], i) => {
    const [r2, z2] = points[(i + 1) % points.length];
    area += r * z2 - r2 * z;
  });
  if (area < 0) points.reverse();
  const normals = points.slice(1).map(([r, z], i) => {
    const dr = r - points[i][0], dz = z - points[i][1], length = Math.hypot(dr, dz);
    return [dz / length, -dr / length];
  });
  const closed = lengthOf([points[0][0] - points[points.length - 1][0], points[0][1] - points[points.length - 1][1], 0]) === 0;
  const bend = (a, b) => (a && b && a[0] * b[0] + a[1] * b[1] > Math.cos(0.7)
    ? [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] : a || b);
  const position = [], normal = [];
  const corner = ([r, z], [nr, nz], k) => {
    const c = Math.cos(2 * Math.PI * k / around), s = Math.sin(2 * Math.PI * k / around), size = Math.hypot(nr, nz);
    position.push(r * c, r * s, z);
    normal.push(nr / size * c, nr / size * s, nz / size);
  };
  normals.forEach((n, i) => {
    const low = bend(n, normals[i - 1] || (closed ? normals[normals.length - 1] : null));
    const high = bend(n, normals[i + 1] || (closed ? normals[0] : null)), p = points[i], q = points[i + 1];
    for (let k = 0; k < around; ++k) {
      if (p[0] > 0) { corner(p, low, k); corner(p, low, k + 1); corner(q, high, k + 1); }
      if (q[0] > 0) { corner(p, low, k); corner(q, high, k + 1); corner(q, high, k); }
    }
  });
  return geometryOf(position, normal);
}

function geometryOf(position, normal) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(position, 3));
  if (normal) geometry.setAttribute("normal", new THREE.Float32BufferAttribute(normal, 3)); else geometry.computeVertexNormals();
  return geometry;
}

function prismGeometry({ prism: { outline, holes, z: [low, high] } }) {
  const path = points => points.map(([x, y]) => new THREE.Vector2(x, y));
  const shape = new THREE.Shape(path(outline));
  shape.holes = list(holes).map(h => new THREE.Path(path(h)));
  const geometry = new THREE.ExtrudeBufferGeometry(shape, { depth: high - low, bevelEnabled: false, curveSegments: 1 });
  return geometry.translate(0, 0, low);
}

const GEOMETRIES = {
  lathe: s => latheGeometry(s.lathe),
  prism: prismGeometry,
  ball: ({ ball }) => new THREE.SphereBufferGeometry(ball.radius, 32, 20).translate(...ball.centre),
  mesh: ({ mesh }) => geometryOf(mesh.triangles.flatMap(i => mesh.points.slice(3 * i, 3 * i + 3))),
  wire: ({ wire: { points, closed } }) => geometryOf(closed ? [...points, ...points.slice(0, 3)] : points, points),
};
const formOf = shape => Object.keys(GEOMETRIES).find(form => shape[form]);

// A shape: its faces, the faces of a cut through it, its edges. A body cut open shows the insides of its faces: drawn flat in
// one colour they look like the cut.
function shapeObject(shape, planes) {
  const form = formOf(shape), geometry = GEOMETRIES[form](shape), colour = LOOKS[shape.look] || LOOKS.shaft;
  const object = new THREE.Group();
  if (form === "wire") {
    object.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: colour })));
    return object;
  }
  const cut = !["shaft", "piston", "pin"].includes(shape.look);  // as in a drawing: what is round and solid is not cut
  const clippingPlanes = cut ? planes : [];
  const faces = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({ color: colour, specular: "#222222", shininess: 25, clippingPlanes,
    transparent: !!shape.see_through, opacity: shape.see_through ? 0.28 : 1, depthWrite: !shape.see_through,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
  const inside = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.BackSide, clippingPlanes,
    color: new THREE.Color(colour).multiplyScalar(0.72) }));
  inside.visible = false;
  const edges = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 35),
    new THREE.LineBasicMaterial({ color: "#2b3640", transparent: true, opacity: 0.45, clippingPlanes }));
  object.add(faces, inside, edges);
  object.userData = { look: shape.look, cut, faces, inside, edges, seeThrough: !!shape.see_through, tint: shape.tint };
  return object;
}

// A body, with what its shapes need at every row.
function bodyObject(body, planes) {
  const object = new THREE.Group();
  object.matrixAutoUpdate = false;
  object.userData = { body: body.name, shapes: list(body.shapes).map(s => shapeObject(s, planes)) };
  object.userData.shapes.forEach(s => object.add(s));
  return object;
}

function placeBody(object, { origin, axes: [x, y, z] }, tintOf) {
  object.matrix.set(x[0], y[0], z[0], origin[0], x[1], y[1], z[1], origin[1], x[2], y[2], z[2], origin[2], 0, 0, 0, 1);
  object.matrixWorldNeedsUpdate = true;
  for (const { userData } of object.userData.shapes)
    if (userData.tint != null) {
      const share = Math.min(1, Math.max(0, tintOf(userData.tint) || 0));
      userData.faces.material.color.set(REST).lerp(new THREE.Color(PRESSURE), share);
    }
}

// ---- Arrows

// Unit geometries along z from 0, shared by all arrows.
let arrowParts = null;
function arrowGeometries() {
  const along = geometry => geometry.rotateX(Math.PI / 2).translate(0, 0, 0.5);
  arrowParts = arrowParts || { shaft: along(new THREE.CylinderBufferGeometry(1, 1, 1, 10)),
                               head: along(new THREE.CylinderBufferGeometry(0, 1, 1, 14)),
                               dot: new THREE.OctahedronBufferGeometry(1, 1) };
  return arrowParts;
}

// An arrow from its tail; that of a moment has two heads. `thickness` in m.
function arrowObject(colour, heads, thickness, pale) {
  const parts = arrowGeometries(), object = new THREE.Group();
  const material = new THREE.MeshLambertMaterial({ color: colour, emissive: colour, emissiveIntensity: 0.35, transparent: true });
  const mesh = geometry => { const m = new THREE.Mesh(geometry, material); object.add(m); return m; };
  object.userData = { shaft: mesh(parts.shaft), heads: Array.from({ length: heads }, () => mesh(parts.head)), dot: mesh(parts.dot),
                      material, thickness, pale };
  return object;
}

// Points the arrow along v (any unit) with a length in m; `least`: it is drawn longer than its share, pale and hollow. A vector of
// no length is a dot.
function setArrow(object, tail, v, length, least) {
  const { shaft, heads, dot, material, thickness, pale } = object.userData, size = lengthOf(v);
  object.position.set(...tail);
  const none = !(size > 0);
  dot.visible = none;
  dot.scale.setScalar(1.6 * thickness);
  shaft.visible = !none;
  heads.forEach(h => { h.visible = !none; });
  material.opacity = pale ? 0.42 : least ? 0.5 : 1;
  material.wireframe = least && !none;
  if (none) return;
  object.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(...times(v, 1 / size)));
  const head = Math.min(5.5 * thickness, 0.5 * length / heads.length), width = Math.min(thickness, 0.35 * head);
  heads.forEach((h, i) => {
    h.position.z = length - (i + 1) * head;
    h.scale.set(2.4 * width, 2.4 * width, head);
  });
  shaft.scale.set(width, width, length - heads.length * head);
}

// Tail and vector (m) of an arrow as it is drawn.
function arrowAsDrawn(object) {
  object.updateMatrixWorld(true);
  const { heads } = object.userData, tail = new THREE.Vector3().setFromMatrixPosition(object.matrixWorld);
  const tip = heads[0].visible ? heads[0].localToWorld(new THREE.Vector3(0, 0, 1)) : tail;
  return { tail: tail.toArray(), drawn: tip.clone().sub(tail).toArray() };
}
