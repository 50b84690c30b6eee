/* A thin layer over WebGL 2: flat boxes, balls, triangles and lines. */

const BOX = [
  `#version 300 es
  in vec2 corner; in vec3 centre; in vec2 size; in float value;
  uniform vec2 flip, move, scale, origin; uniform float grow; out float shade;
  void main() {
    vec2 at = centre.xy * flip + move + corner * size * grow;
    gl_Position = vec4(at * scale + origin, 0.0, 1.0);
    shade = value;
  }`,
  `#version 300 es
  precision mediump float;
  in float shade; uniform sampler2D colours; out vec4 colour;
  void main() { colour = texture(colours, vec2((shade * 255.0 + 0.5) / 256.0, 0.5)); }`,
];

/* Sums over boxes, each spread over a disc: of values, of areas (1 inside, 1/2 at a surface), and of areas with a value. */
const SPREAD = [
  `#version 300 es
  in vec2 corner; in vec3 centre; in vec2 size; in float value;
  uniform vec2 flip, move, scale, origin; uniform float reach; out float shade, weight; out vec2 place;
  void main() {
    vec2 at = centre.xy * flip + move + corner * reach;
    gl_Position = vec4(at * scale + origin, 0.0, 1.0);
    weight = 12.0 * size.x * size.y / (3.14159265 * reach * reach);
    place = corner;
    shade = value;
  }`,
  `#version 300 es
  precision highp float;
  in float shade, weight; in vec2 place; out vec4 sums;
  void main() {
    float inner = max(0.0, 1.0 - dot(place, place));
    float part = weight * inner * inner;
    float known = step(0.0, shade);
    sums = vec4(part * shade * known, part, part * known, 1.0);
  }`,
];

/* Colour where the sum of areas is above 1/2. */
const FILL = [
  `#version 300 es
  in vec2 corner; out vec2 place;
  void main() { place = 0.5 * corner + 0.5; gl_Position = vec4(corner, 0.0, 1.0); }`,
  `#version 300 es
  precision highp float;
  in vec2 place; uniform sampler2D sums, colours; uniform float stepped; out vec4 colour;
  void main() {
    vec3 sum = texture(sums, place).rgb;
    float soft = max(fwidth(sum.g), 1e-4);
    float cover = smoothstep(0.5 - soft, 0.5 + soft, sum.g);
    float mean = sum.r / max(sum.b, 1e-6);
    float shade = sum.b < 0.5 * sum.g ? -1.0 : mix(mean, step(0.5, mean), stepped);
    colour = vec4(texture(colours, vec2((shade * 255.0 + 0.5) / 256.0, 0.5)).rgb * cover, cover);
  }`,
];

const BALL = [
  `#version 300 es
  in vec2 corner; in vec3 centre; in vec2 size; in float value;
  uniform vec3 flip, move; uniform mat4 view, lens; uniform float grow;
  out float shade; out vec2 place; out vec3 eye; out float radius;
  void main() {
    radius = size.x * grow;
    eye = (view * vec4(centre * flip + move, 1.0)).xyz + vec3(corner * radius, 0.0);
    gl_Position = lens * vec4(eye, 1.0);
    place = corner;
    shade = value;
  }`,
  `#version 300 es
  precision highp float;
  in float shade; in vec2 place; in vec3 eye; in float radius;
  uniform sampler2D colours; uniform mat4 lens; out vec4 colour;
  void main() {
    float square = dot(place, place);
    if (square > 1.0) discard;
    vec3 normal = vec3(place, sqrt(1.0 - square));
    vec4 surface = lens * vec4(eye + vec3(0.0, 0.0, radius * normal.z), 1.0);
    gl_FragDepth = 0.5 * surface.z / surface.w + 0.5;
    float light = 0.45 + 0.6 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.65, 0.7))));
    vec3 base = texture(colours, vec2((shade * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    colour = vec4(base * light, 1.0);
  }`,
];

const FACET = [
  `#version 300 es
  in vec3 point; uniform mat4 model, view, lens; out vec3 eye;
  void main() { vec4 at = view * model * vec4(point, 1.0); eye = at.xyz; gl_Position = lens * at; }`,
  `#version 300 es
  precision highp float;
  in vec3 eye; uniform vec4 tint; uniform float lit; out vec4 colour;
  void main() {
    float facing = abs(normalize(cross(dFdx(eye), dFdy(eye))).z);
    colour = vec4(tint.rgb, tint.a * mix(1.0, 1.3 - 0.8 * facing, lit));
  }`,
];

class Surface {
  /** Throws an Error where the browser has no WebGL 2. */
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true, alpha: true });
    if (!gl) throw new Error('no WebGL');
    this.gl = gl;
    this.boxes = this.program(BOX);
    this.balls = this.program(BALL);
    this.facets = this.program(FACET);
    this.spread = this.program(SPREAD);
    this.fill = this.program(FILL);
    this.sums = gl.getExtension('EXT_color_buffer_float') || gl.getExtension('EXT_color_buffer_half_float') ? this.target() : null;
    this.corners = this.filled(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));
    this.rows = gl.createBuffer();
    this.palette = gl.createTexture();
    this.shapes = new Map();
  }

  program([vertex, fragment]) {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return { program, places: new Map(), attributes: new Map() };
  }

  filled(array, kind = this.gl.ARRAY_BUFFER) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(kind, buffer);
    this.gl.bufferData(kind, array, this.gl.STATIC_DRAW);
    return buffer;
  }

  /** Set the uniforms of a program by name: 1 to 4 numbers, or 16. */
  set(of, numbers) {
    const { gl } = this;
    for (const [name, value] of Object.entries(numbers)) {
      if (!of.places.has(name)) of.places.set(name, gl.getUniformLocation(of.program, name));
      const place = of.places.get(name);
      if (typeof value === 'number') gl.uniform1f(place, value);
      else if (value.length === 16) gl.uniformMatrix4fv(place, false, value);
      else gl[`uniform${value.length}fv`](place, value);
    }
  }

  attribute(of, name, size, stride, offset, each) {
    const { gl } = this;
    if (!of.attributes.has(name)) of.attributes.set(name, gl.getAttribLocation(of.program, name));
    const place = of.attributes.get(name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(place, each);
    return place;
  }

  /** Adopt the size of the canvas on the screen, and clear it. */
  clear() {
    const { gl, canvas } = this;
    const density = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(canvas.clientWidth * density), Math.round(canvas.clientHeight * density)];
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    return density;
  }

  colours(bytes) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.palette);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  }

  /** Take the particles of a flow. */
  particles(flow) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.rows);
    gl.bufferData(gl.ARRAY_BUFFER, flow.rows.subarray(0, 6 * flow.count), gl.DYNAMIC_DRAW);
    this.count = flow.count;
  }

  /** Draw the particles with the program `boxes` or `balls`. */
  draw(of, numbers) {
    const { gl } = this;
    gl.useProgram(of.program);
    this.set(of, numbers);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    const places = [this.attribute(of, 'corner', 2, 0, 0, 0)];
    gl.bindBuffer(gl.ARRAY_BUFFER, this.rows);
    places.push(this.attribute(of, 'centre', 3, 24, 0, 1), this.attribute(of, 'size', 2, 24, 12, 1), this.attribute(of, 'value', 1, 24, 20, 1));
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    for (const place of places) gl.disableVertexAttribArray(place);
  }

  /** A texture of half precision, and the framebuffer that draws into it. */
  target() {
    return { texture: this.gl.createTexture(), frame: this.gl.createFramebuffer(), width: 0, height: 0 };
  }

  /** Add up areas and values of all images of the particles, and fill the material with their mean. */
  blend(images, numbers, stepped) {
    const { gl, canvas, sums } = this;
    if (!sums) return; // without float textures, draw only boxes
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.frame);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, sums.texture);
    if (sums.width !== canvas.width || sums.height !== canvas.height) {
      [sums.width, sums.height] = [canvas.width, canvas.height];
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, sums.width, sums.height, 0, gl.RGBA, gl.HALF_FLOAT, null);
      for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, sums.texture, 0);
    }
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    for (const { flip, move } of images) this.draw(this.spread, { ...numbers, flip, move });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.useProgram(this.fill.program);
    gl.uniform1i(gl.getUniformLocation(this.fill.program, 'sums'), 1);
    this.set(this.fill, { stepped: stepped ? 1 : 0 });
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    const place = this.attribute(this.fill, 'corner', 2, 0, 0, 0);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disableVertexAttribArray(place);
    gl.activeTexture(gl.TEXTURE0);
  }

  /** Draw the triangles of a shape, or pairs of points with `lines`; the shape is cached. */
  facet(shape, numbers, lines = false) {
    const { gl, facets } = this;
    if (!this.shapes.has(shape)) {
      const parts = this.filled(shape.parts, gl.ELEMENT_ARRAY_BUFFER);
      this.shapes.set(shape, { points: this.filled(shape.points), parts });
    }
    const { points, parts } = this.shapes.get(shape);
    gl.useProgram(facets.program);
    this.set(facets, numbers);
    gl.bindBuffer(gl.ARRAY_BUFFER, points);
    const place = this.attribute(facets, 'point', 3, 0, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, parts);
    gl.drawElements(lines ? gl.LINES : gl.TRIANGLES, shape.parts.length, gl.UNSIGNED_INT, 0);
    gl.disableVertexAttribArray(place);
  }
}

/** The mirror images of the material: flips and shifts along each axis; the first is the original. */
function images(mirrors) {
  let found = [{ flip: mirrors.map(() => 1), move: mirrors.map(() => 0) }];
  mirrors.forEach((plane, axis) => {
    if (plane === null) return;
    const more = found.map(({ flip, move }) => ({
      flip: flip.map((f, a) => (a === axis ? -f : f)),
      move: move.map((m, a) => (a === axis ? 2 * plane - m : m)),
    }));
    found = [...found, ...more];
  });
  return found;
}
