// The interactive view: one WebGL2 context draws for every canvas of the page. Light, curvature and stripes are
// computed for each pixel from the exact normals and curvatures that came with the samples. Nothing is fetched.
"use strict";
(() => {
  const VERTEX = `#version 300 es
    layout(location = 0) in vec3 position;  // 0 to 1 within the box of the model
    layout(location = 1) in float bend;     // mean curvature over its limit
    layout(location = 2) in vec3 normal;
    uniform mat3 turn; uniform vec3 middle, box; uniform vec2 scale, shift; uniform float size, lift;
    out vec3 n, p; out float h;
    void main() {
      p = turn * (position * box - middle);
      n = turn * normal; h = bend;
      gl_Position = vec4(p.xy * scale + shift, -p.z * 0.25 - lift, 1.0);
      gl_PointSize = size;
    }`;
  const FRAGMENT = `#version 300 es
    precision highp float;
    in vec3 n, p; in float h; out vec4 color;
    uniform int mode; uniform vec3 paint;
    vec3 diverging(float t) {  // blue, light grey, red
      vec3 grey = vec3(0.87), blue = vec3(0.23, 0.30, 0.75), red = vec3(0.71, 0.02, 0.15);
      return t < 0.0 ? mix(grey, blue, min(-t, 1.0)) : mix(grey, red, min(t, 1.0));
    }
    void main() {
      if (mode == 3) { color = vec4(paint, 1.0); return; }
      vec3 m = normalize(n);
      if (m.z < 0.0) m = -m;  // both sides are lit
      float light = 0.35 + 0.65 * max(dot(m, normalize(vec3(-0.3, 0.5, 0.8))), 0.0);
      if (mode == 0) {
        float gloss = pow(max(dot(reflect(vec3(0, 0, -1), m), normalize(vec3(-0.3, 0.5, 0.8))), 0.0), 24.0);
        color = vec4(paint * light + 0.25 * gloss, 1.0);
      } else if (mode == 1) {
        color = vec4(diverging(n.z < 0.0 ? h : -h) * (0.55 + 0.45 * light), 1.0);  // positive: bulges towards the eye
      } else {  // stripes of 4.5 degrees around an axis that lies across the picture, mirrored, seen from near by
        vec3 sight = normalize(p - vec3(0, 0, 2.2));
        float s = degrees(acos(clamp(dot(reflect(sight, m), vec3(0.70710678, 0.70710678, 0.0)), -1.0, 1.0))) / 9.0;
        float wave = 4.0 * abs(fract(s) - 0.5) - 1.0, soft = clamp(4.0 * fwidth(s), 0.001, 1.0);
        color = vec4(mix(paint * 0.9, vec3(0.97), smoothstep(-soft, soft, wave)) * (0.7 + 0.3 * light), 1.0);
      }
    }`;
  const MODES = { shaded: 0, curvature: 1, zebra: 2 };
  const CURVES = ["#0b3c8c", "#e8a200", "#6a0dad", "#00a0b0", "#111111", "#c2185b", "#5d4037", "#ffe14d"];

  const target = document.createElement("canvas");
  const gl = target.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) {
    for (const view of document.querySelectorAll(".viewer")) {
      view.textContent = "This browser has no WebGL2, so there is no interactive view; the pictures show the same.";
    }
    return;
  }
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  const at = (name) => gl.getUniformLocation(program, name);
  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

  // Vertices of 16 bytes: 3 positions and the curvature, then the normal and padding, all of 16 bits.
  function upload(piece) {
    const { rows, columns } = piece, index = [], edges = [];
    const corner = (i, j) => i * columns + j;
    for (let i = 0; i + 1 < rows; i++) for (let j = 0; j + 1 < columns; j++) {
      const [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
      index.push(a, b, c, a, c, d);
    }
    for (let j = 0; j + 1 < columns; j++) for (const i of [0, rows - 1]) edges.push(corner(i, j), corner(i, j + 1));
    for (let i = 0; i + 1 < rows; i++) for (const j of [0, columns - 1]) edges.push(corner(i, j), corner(i + 1, j));
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, bytes(piece.vertices), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0); gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, 16, 0);
    gl.enableVertexAttribArray(1); gl.vertexAttribPointer(1, 1, gl.SHORT, true, 16, 6);
    gl.enableVertexAttribArray(2); gl.vertexAttribPointer(2, 3, gl.SHORT, true, 16, 8);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array([...index, ...edges]), gl.STATIC_DRAW);
    return { array, triangles: index.length, lines: edges.length, paint: rgb(piece.color) };
  }

  function uploadPolygons(polygons) {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(bytes(polygons.points).buffer), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0); gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
    return { array, counts: polygons.counts };
  }

  const product = (a, b) => a.map((row) => [0, 1, 2].map((j) => row.reduce((sum, x, k) => sum + x * b[k][j], 0)));
  function turned(turn, x, y) {
    const [c, s, d, t] = [Math.cos(x), Math.sin(x), Math.cos(y), Math.sin(y)];
    return product([[1, 0, 0], [0, d, -t], [0, t, d]], product([[c, 0, s], [0, 1, 0], [-s, 0, c]], turn));
  }

  function start(view) {
    const model = JSON.parse(view.querySelector("script").textContent);
    const canvas = view.querySelector("canvas"), picture = canvas.getContext("2d");
    const choice = view.querySelector("select"), points = view.querySelector("input");
    const first = () => ({ turn: model.camera, zoom: 1, shift: [0, 0] });
    let mode = "shaded", pose = first(), waiting = false, visible = false;
    const ready = new Map();
    const loaded = (key, make) => ready.get(key) ?? ready.set(key, make()).get(key);

    function paint() {
      waiting = false;
      const ratio = window.devicePixelRatio || 1;
      const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
      if (!visible || !width || !height) return;
      if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
      if (target.width !== width || target.height !== height) Object.assign(target, { width, height });
      gl.viewport(0, 0, width, height);
      gl.clearColor(1, 1, 1, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.uniformMatrix3fv(at("turn"), true, pose.turn.flat());
      gl.uniform3fv(at("middle"), model.middle);
      gl.uniform2fv(at("shift"), pose.shift);
      const fit = pose.zoom * Math.min(width, (height * 8) / 5);
      gl.uniform2f(at("scale"), (fit / width) * model.fit, (fit / height) * model.fit);
      const chosen = Number(choice.value), blend = model.blends[chosen];
      const pieces = [...model.bases, blend].map((piece, i) => loaded(i < 2 ? `base ${i}` : chosen, () => upload(piece)));
      gl.uniform3fv(at("box"), model.box);
      for (const piece of pieces) {
        gl.bindVertexArray(piece.array);
        gl.uniform1i(at("mode"), MODES[mode]);
        gl.uniform1f(at("lift"), 0);
        gl.uniform3fv(at("paint"), piece.paint);
        gl.drawElements(gl.TRIANGLES, piece.triangles, gl.UNSIGNED_INT, 0);
        gl.uniform1i(at("mode"), 3);
        gl.uniform1f(at("lift"), 0.002);  // edges lie on top of their own surface
        gl.uniform3f(at("paint"), 0.12, 0.12, 0.12);
        gl.drawElements(gl.LINES, piece.lines, gl.UNSIGNED_INT, 4 * piece.triangles);
      }
      if (points.checked && blend.polygons) {
        const polygons = loaded(`points ${chosen}`, () => uploadPolygons(blend.polygons));
        gl.bindVertexArray(polygons.array);
        gl.disable(gl.DEPTH_TEST);
        gl.uniform3f(at("box"), 1, 1, 1);
        gl.uniform1f(at("size"), 5 * ratio);
        let begin = 0;
        polygons.counts.forEach((count, i) => {
          gl.uniform3fv(at("paint"), rgb(CURVES[i % CURVES.length]));
          gl.drawArrays(gl.LINE_STRIP, begin, count);
          gl.drawArrays(gl.POINTS, begin, count);
          begin += count;
        });
      }
      picture.drawImage(target, 0, 0);
    }
    const draw = () => { if (!waiting) { waiting = true; requestAnimationFrame(paint); } };
    function describe() {
      const blend = model.blends[Number(choice.value)];
      view.querySelector(".numbers").textContent = blend.caption;
      points.disabled = !blend.polygons;
      view.querySelector(".scale").hidden = mode !== "curvature";
      for (const button of view.querySelectorAll("[data-mode]")) {
        button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
      }
      draw();
    }
    const change = (x, y) => { pose = { ...pose, turn: turned(pose.turn, x, y) }; draw(); };
    const zoom = (factor) => { pose = { ...pose, zoom: Math.min(Math.max(pose.zoom * factor, 0.2), 40) }; draw(); };
    const move = (x, y) => { pose = { ...pose, shift: [pose.shift[0] + x, pose.shift[1] + y] }; draw(); };

    for (const button of view.querySelectorAll("[data-mode]")) {
      button.addEventListener("click", () => { mode = button.dataset.mode; describe(); });
    }
    view.querySelector("[data-reset]").addEventListener("click", () => { pose = first(); draw(); });
    choice.addEventListener("change", describe);
    points.addEventListener("change", draw);
    // One finger or the mouse turns, shift or the other button moves, two fingers zoom.
    const held = new Map();
    const apart = () => { const [a, b] = held.values(); return Math.hypot(a.x - b.x, a.y - b.y); };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      canvas.focus({ preventScroll: true });
      held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    canvas.addEventListener("pointermove", (event) => {
      const last = held.get(event.pointerId);
      if (!last) return;
      const before = held.size === 2 ? apart() : 0;
      const [x, y] = [event.clientX - last.x, event.clientY - last.y];
      held.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (held.size === 2) zoom(apart() / Math.max(before, 1));
      else if (event.shiftKey || event.buttons === 2) move((2 * x) / canvas.clientWidth, (-2 * y) / canvas.clientHeight);
      else change(x / 150, y / 150);
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (e) => held.delete(e.pointerId));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    // Only where the view has the focus: else the wheel would stop the page from scrolling.
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas) return;
      event.preventDefault();
      zoom(Math.exp(-event.deltaY / 600));
    }, { passive: false });
    const keys = {
      ArrowLeft: () => change(-0.1, 0), ArrowRight: () => change(0.1, 0), ArrowUp: () => change(0, -0.1),
      ArrowDown: () => change(0, 0.1), "+": () => zoom(1.2), "-": () => zoom(1 / 1.2),
    };
    canvas.addEventListener("keydown", (event) => {
      if (keys[event.key]) { event.preventDefault(); keys[event.key](); }
    });
    new ResizeObserver(draw).observe(canvas);
    new IntersectionObserver((seen) => { visible = seen[seen.length - 1].isIntersecting; draw(); },
      { rootMargin: "300px" }).observe(canvas);
    describe();
  }
  document.querySelectorAll(".viewer").forEach(start);
})();
