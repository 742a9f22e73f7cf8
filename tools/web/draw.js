/* draw.js - draws a mesh by WebGL 2: flat-shaded faces coloured by a number each, edges as lines of constant width on
   the screen, forces as their width and colour, vertices as discs.

   Lines and discs have soft rims of their own, which is smoother than the samples of antialiasing, and without a GPU
   takes less than half of the time.

   Vertices, faces and edges lie in textures of floats; a buffer and another texture hold only numbers. So a frame is
   three uploads. */
'use strict';

const ROW = 1024; // texels in a row of these textures

const shaderHead = `#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D places, values, forces;
uniform mat4 camera;
uniform vec3 eye;
uniform vec2 screen; // in pixels
ivec2 texel(uint k) { return ivec2(int(k) & ${ROW - 1}, int(k) / ${ROW}); }
vec3 place(uint v) { return texelFetch(places, texel(v), 0).xyz; }
uniform vec3 flatColour, middleColour, warnColour;
vec3 ramp(float t) { // lightness goes one way, so that no one needs to tell hues apart
    return t < 0.5 ? mix(flatColour, middleColour, 2.0 * t) : mix(middleColour, warnColour, min(1.0, 2.0 * t - 1.0));
}
vec4 towards(vec3 p, float way) { return camera * vec4(p + normalize(eye - p) * way, 1); } // what is drawn upon faces
`;

const shaders = {
    face: [
        `${shaderHead}
layout(location = 0) in uvec2 corner; // vertex, face
uniform float marked; // a face's number, < 0: none
out vec3 at;
flat out float value, mark;
void main() {
    at = place(corner.x);
    value = texelFetch(values, texel(corner.y), 0).x;
    mark = float(corner.y) == marked ? 1.0 : 0.0;
    gl_Position = camera * vec4(at, 1);
}`,
        `${shaderHead}
uniform vec3 handleColour;
in vec3 at;
flat in float value, mark;
out vec4 colour;
void main() {
    vec3 n = normalize(cross(dFdx(at), dFdy(at))), look = normalize(eye - at);
    if (dot(n, look) < 0.0) n = -n;
    vec3 light = normalize(look + vec3(0, 0, 0.9));
    float shade = 0.78 + 0.24 * dot(n, light);
    colour = vec4(mix(ramp(value), handleColour, 0.55 * mark) * min(shade, 1.04), 1);
}`
    ],
    edge: [
        `${shaderHead}
uniform highp usampler2D pairs; // the ends of edges; six vertices each: an instance each is slow where no GPU is
uniform float width, byForce, byLength;
flat out float told, half_width;
out float off; // from the middle of the line, in pixels
void main() {
    uint edge = uint(gl_VertexID / 6), corner = uint(gl_VertexID % 6);
    uvec2 ends = texelFetch(pairs, texel(edge), 0).xy;
    if (corner > 2u) corner -= 2u; // 0 1 2, 1 2 3
    told = (byForce + byLength) * texelFetch(forces, texel(edge), 0).x;
    float way = 0.004 * (1.0 + abs(told));
    float wide = width * (1.0 + byForce * 7.0 * sqrt(abs(told)) + byLength * 3.0 * told * told);
    vec4 a = towards(place(ends.x), way), b = towards(place(ends.y), way);
    vec2 along = (b.xy / b.w - a.xy / a.w) * screen;
    along = length(along) > 1e-6 ? normalize(along) : vec2(1, 0);
    vec4 p = (corner & 1u) == 0u ? a : b;
    half_width = max(wide, 1.0) / 2.0;
    off = (corner < 2u ? 1.0 : -1.0) * (half_width + 1.0);
    p.xy += vec2(-along.y, along.x) * 2.0 * off / screen * p.w;
    gl_Position = p;
}`,
        `${shaderHead}
uniform vec3 lineColour, pushColour, pullColour;
uniform float opacity, byLength;
flat in float told, half_width;
in float off;
out vec4 colour;
void main() {
    float t = smoothstep(0.0, 0.05, abs(told));
    colour = vec4(mix(lineColour, told > 0.0 ? pushColour : pullColour, t), mix(opacity, 0.95, t));
    // from half of the full length on: all edges of a mesh are about alike
    if (byLength > 0.0) colour = vec4(mix(lineColour, ramp(2.0 * told - 1.0), smoothstep(0.5, 0.6, told)), 0.95);
    colour.a *= clamp(half_width + 0.5 - abs(off), 0.0, 1.0);
}`
    ],
    disc: [
        `${shaderHead}
layout(location = 0) in uvec2 which; // vertex, kind
uniform float size;
out vec2 at;
flat out uint kind;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec4 p = towards(place(which.x), 0.02);
    kind = which.y;
    at = corner;
    p.xy += corner * size * (kind == 1u ? 0.8 : kind == 2u ? 1.25 : kind == 3u ? 2.2 : 0.95) / screen * p.w * 2.0;
    gl_Position = p;
}`,
        `${shaderHead}
uniform vec3 fixedColour, handleColour, paperColour;
in vec2 at;
flat in uint kind;
out vec4 colour;
void main() {
    float r = length(at), soft = fwidth(r);
    if (r > 1.0) discard;
    if (kind == 3u && r < 0.66) discard; // a ring around a vertex that the verdict names
    vec3 inside = kind == 1u ? fixedColour : handleColour;
    float rim = kind == 3u ? 0.0 : smoothstep(0.72 - soft, 0.72, r);
    colour = vec4(mix(inside, paperColour, rim), 1.0 - smoothstep(1.0 - soft, 1.0, r));
}`
    ],
};

/* "#rrggbb" of a custom property, as three numbers in 0..1. */
function colourOf(name) {
    const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    return [1, 3, 5].map(k => parseInt(text.slice(k, k + 2), 16) / 255);
}

class Drawing {
    constructor(canvas) {
        this.canvas = canvas;
        this.gl = canvas.getContext('webgl2', {antialias: false, alpha: false});
        if (!this.gl) throw new Error('This browser has no WebGL 2, which the page draws with.');
        this.view = {yaw: -1.05, pitch: 0.5, distance: 4, target: [0, 0, 0]};
        this.telling = 'planarity'; // see `colours` in page.js
        this.marked = -1;           // a face
        this.counts = {vertices: 0, faces: 0, edges: 0};
        this.points = [];
        this.start();
        canvas.addEventListener('webglcontextlost', event => event.preventDefault());
        canvas.addEventListener('webglcontextrestored', () => {
            this.start();
            if (this.mesh) this.setMesh(this.mesh), this.setFrame(this.frame), this.setPoints(this.points);
        });
    }

    start() {
        const gl = this.gl;
        this.programs = {};
        for (const [name, sources] of Object.entries(shaders)) {
            const program = gl.createProgram();
            sources.forEach((source, k) => {
                const shader = gl.createShader(k ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
                gl.shaderSource(shader, source);
                gl.compileShader(shader);
                gl.attachShader(program, shader);
            });
            gl.linkProgram(program);
            if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
                throw new Error(`${name}: ${gl.getProgramInfoLog(program)}`);
            this.programs[name] = program;
        }
        this.arrays = {};
        for (const name of ['face', 'disc']) {
            const array = gl.createVertexArray(), buffer = gl.createBuffer();
            gl.bindVertexArray(array);
            gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
            gl.enableVertexAttribArray(0);
            gl.vertexAttribIPointer(0, 2, gl.UNSIGNED_INT, 0, 0);
            if (name !== 'face') gl.vertexAttribDivisor(0, 1);
            this.arrays[name] = {array, buffer};
        }
        this.arrays.edge = {array: gl.createVertexArray()};
        this.textures = ['places', 'values', 'forces'].map(name => ({name, texture: gl.createTexture()}));
        this.pairs = {name: 'pairs', texture: gl.createTexture()};
        this.readColours();
    }

    readColours() {
        this.colours = {};
        for (const name of ['background', 'flat', 'middle', 'warn', 'line', 'push', 'pull', 'fixed', 'handle', 'paper'])
            this.colours[name] = colourOf('--' + name);
    }

    fill(name, data, use) {
        const gl = this.gl;
        gl.bindBuffer(gl.ARRAY_BUFFER, this.arrays[name].buffer);
        gl.bufferData(gl.ARRAY_BUFFER, data, use);
    }

    /* {vertices, faces, edges, corners, ends} as worker.js sends them. */
    setMesh(mesh) {
        const gl = this.gl, counts = [mesh.vertices, mesh.faces, mesh.edges];
        this.mesh = mesh;
        this.counts = mesh;
        this.fill('face', mesh.corners, gl.STATIC_DRAW);
        const store = (t, ...format) => {
            gl.bindTexture(gl.TEXTURE_2D, t.texture);
            gl.texImage2D(gl.TEXTURE_2D, 0, format[0], ROW, t.rows, 0, ...format.slice(1));
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        };
        this.pairs.rows = Math.max(1, Math.ceil(mesh.edges / ROW));
        const ends = new Uint32Array(2 * ROW * this.pairs.rows);
        ends.set(mesh.ends);
        store(this.pairs, gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT, ends);
        this.textures.forEach((t, k) => {
            t.rows = Math.max(1, Math.ceil(counts[k] / ROW));
            t.data = new Float32Array(t.rows * ROW * (k ? 1 : 4));
            store(t, k ? gl.R32F : gl.RGBA32F, k ? gl.RED : gl.RGBA, gl.FLOAT, null);
        });
        this.setPoints([]);
    }

    /* Floats: 4 for each vertex, 1 for each face, 1 for each edge. They are copied. */
    setFrame(frame) {
        const gl = this.gl, {vertices, faces, edges} = this.counts;
        const parts = [frame.subarray(0, 4 * vertices), frame.subarray(4 * vertices, 4 * vertices + faces),
            frame.subarray(4 * vertices + faces, 4 * vertices + faces + edges)];
        this.textures.forEach((t, k) => {
            t.data.set(parts[k]);
            gl.bindTexture(gl.TEXTURE_2D, t.texture);
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ROW, t.rows, k ? gl.RED : gl.RGBA, gl.FLOAT, t.data);
        });
        this.frame = frame.slice();
    }

    get places() { return this.textures[0].data; }
    get values() { return this.textures[1].data.subarray(0, this.counts.faces); }
    get forces() { return this.textures[2].data.subarray(0, this.counts.edges); }

    /* Pairs [vertex, kind] of discs: kind 1 is fixed, 2 is the handle, 3 is named by the verdict, 4 is under the
       pointer. */
    setPoints(points) {
        this.points = points;
        this.fill('disc', new Uint32Array(points.flat()), this.gl.DYNAMIC_DRAW);
    }

    /* -- the camera: z is up; right, up and back are the axes of the view -- */

    axes() {
        const {yaw, pitch} = this.view, c = Math.cos(pitch), s = Math.sin(pitch), cy = Math.cos(yaw),
                    sy = Math.sin(yaw);
        return {right: [-sy, cy, 0], up: [-s * cy, -s * sy, c], back: [c * cy, c * sy, s]};
    }

    eye() {
        const {back} = this.axes(), {target, distance} = this.view;
        return target.map((t, k) => t + distance * back[k]);
    }

    /* The camera's matrix, by columns. */
    matrix() {
        const {right, up, back} = this.axes(), eye = this.eye();
        const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        const middle = dot(back, eye); // a mesh as it was opened has the radius 1 about the origin
        const aspect = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
        const focal = 3.2 * Math.min(1, aspect), near = Math.max(0.02, middle - 2), far = Math.max(1, middle + 2);
        const rows = [right, up, back].map(axis => [...axis, -dot(axis, eye)]);
        const depth = (far + near) / (near - far), shift = 2 * far * near / (near - far), m = [];
        for (let k = 0; k < 4; ++k)
            m.push(focal / aspect * rows[0][k], focal * rows[1][k], depth * rows[2][k] + (k === 3 ? shift : 0),
                -rows[2][k]);
        return m;
    }

    /* Where a point is on the canvas, in CSS pixels: [x, y, distance from the eye]. */
    project(p, m = this.matrix()) {
        const [x, y, , w] = [0, 1, 2, 3].map(r => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
        return [(x / w + 1) / 2 * this.canvas.clientWidth, (1 - y / w) / 2 * this.canvas.clientHeight, w];
    }

    place(vertex) { return Array.from(this.places.subarray(4 * vertex, 4 * vertex + 3)); }

    /* How far a point at the distance w moves per CSS pixel. */
    pixel(w) {
        const aspect = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
        return 2 * w / (3.2 * Math.min(1, aspect) * this.canvas.clientHeight);
    }

    /* The vertex at a place on the canvas: within 14 CSS pixels, 26 of a finger, but less where edges are short, so
       that there is room between vertices to turn the view. Of several the nearest to the eye. -1: none. */
    pick(x, y, finger) {
        if (!this.mesh) return -1;
        const m = this.matrix(), {edge} = this.mesh, p = this.places, width = this.canvas.clientWidth / 2,
              height = this.canvas.clientHeight / 2;
        const long = edge / this.pixel(this.view.distance),
              radius = finger ? Math.max(9, Math.min(26, long / 2)) : Math.max(5, Math.min(14, long / 3));
        let best = -1, least = Infinity;
        for (let v = 0, k = 0; v < this.counts.vertices; ++v, k += 4) {
            const w = m[3] * p[k] + m[7] * p[k + 1] + m[11] * p[k + 2] + m[15];
            const dx = ((m[0] * p[k] + m[4] * p[k + 1] + m[8] * p[k + 2] + m[12]) / w + 1) * width - x;
            const dy = (1 - (m[1] * p[k] + m[5] * p[k + 1] + m[9] * p[k + 2] + m[13]) / w) * height - y;
            const off = Math.sqrt(dx * dx + dy * dy),
                  cost = w + 0.7 * edge * off / radius; // nearer ones first, then those below
            if (off <= radius && cost < least) best = v, least = cost;
        }
        return best;
    }

    /* -- drawing -- */

    use(name, uniforms) {
        const gl = this.gl, program = this.programs[name];
        gl.useProgram(program);
        gl.bindVertexArray(this.arrays[name].array);
        for (const [key, value] of Object.entries(uniforms)) {
            const at = gl.getUniformLocation(program, key);
            if (!at) continue;
            if (typeof value === 'number') gl.uniform1f(at, value);
            else if (value.length === 16) gl.uniformMatrix4fv(at, false, value);
            else if (value.length === 2) gl.uniform2fv(at, value);
            else gl.uniform3fv(at, value);
        }
        [...this.textures, this.pairs].forEach((t, k) => {
            gl.activeTexture(gl.TEXTURE0 + k);
            gl.bindTexture(gl.TEXTURE_2D, t.texture);
            gl.uniform1i(gl.getUniformLocation(program, t.name), k);
        });
        gl.activeTexture(gl.TEXTURE0);
    }

    /* Is the last picture still being drawn? Another one would make the page's thread wait. */
    get busy() {
        const {gl, fence} = this;
        if (fence && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost()) return true;
        if (fence) gl.deleteSync(fence);
        this.fence = null;
        return false;
    }

    draw() {
        this.drawAll();
        this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        this.gl.flush();
    }

    drawAll() {
        const gl = this.gl, canvas = this.canvas, ratio = Math.min(2, devicePixelRatio || 1), c = this.colours;
        const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
        if (canvas.width !== width || canvas.height !== height) canvas.width = width, canvas.height = height;
        gl.viewport(0, 0, width, height);
        gl.clearColor(...c.background, 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        if (!this.mesh) return;
        const shared = {camera: this.matrix(), screen: [width, height], eye: this.eye(),
            flatColour: c.flat, middleColour: c.middle, warnColour: c.warn};
        const byForce = Number(this.telling === 'forces'), byLength = Number(this.telling === 'lengths');
        const pixels = this.mesh.edge / this.pixel(this.view.distance); // of a mean edge, on the screen
        gl.enable(gl.DEPTH_TEST);
        gl.disable(gl.BLEND);
        gl.enable(gl.POLYGON_OFFSET_FILL);
        gl.polygonOffset(1, 1);
        this.use('face', {...shared, handleColour: c.handle, marked: this.marked});
        gl.drawArrays(gl.TRIANGLES, 0, this.mesh.corners.length / 2);
        gl.disable(gl.POLYGON_OFFSET_FILL);
        gl.enable(gl.BLEND);
        gl.depthMask(false); // rims would hide lines behind them
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        this.use('edge', {
            ...shared,
            width: ratio * Math.min(1.3, 0.4 + pixels / 30),
            byForce,
            byLength,
            opacity: byForce ? 0.3 : Math.min(0.75, pixels / 14),
            lineColour: c.line,
            pushColour: c.push,
            pullColour: c.pull
        });
        gl.drawArrays(gl.TRIANGLES, 0, 6 * this.mesh.edges);
        this.use(
            'disc', {...shared, size: 4.5 * ratio, fixedColour: c.fixed, handleColour: c.handle, paperColour: c.paper});
        if (this.points.length) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.points.length);
        gl.depthMask(true);
    }
}
