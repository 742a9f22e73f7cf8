/* draw.js - draws a mesh by WebGL 2: flat-shaded faces coloured by a number each, edges as lines of constant width on
   the screen, forces as their width and colour, vertices as discs. Without a GPU a picture takes long, and so this runs
   in a worker of its own, or in the page where workers have no WebGL 2 (Safari before 17): see startPainter in page.js.

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

/* Messages {does: name, ...} name the methods setMesh, setFrame, setPoints and draw. Answers are {is: 'back', buffer},
   which gives a frame's buffer back, {is: 'drawn'}, and {is: 'restored'} when the browser has lost what was set. */
class Painter {
    constructor(canvas, answer) {
        this.canvas = canvas;
        this.answer = answer;
        this.gl = canvas.getContext('webgl2', {antialias: false, alpha: false});
        if (!this.gl) throw new Error('This browser has no WebGL 2, which the page draws with.');
        this.start();
        canvas.addEventListener('webglcontextlost', event => event.preventDefault());
        canvas.addEventListener('webglcontextrestored', () => {
            this.start();
            answer({is: 'restored'});
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
    }

    fill(name, data, use) {
        const gl = this.gl;
        gl.bindBuffer(gl.ARRAY_BUFFER, this.arrays[name].buffer);
        gl.bufferData(gl.ARRAY_BUFFER, data, use);
    }

    /* {vertices, faces, edges, corners, ends} as worker.js sends them. */
    setMesh({mesh}) {
        const gl = this.gl, counts = [mesh.vertices, mesh.faces, mesh.edges];
        this.mesh = mesh;
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
    }

    /* Floats: 4 for each vertex, 1 for each face, 1 for each edge. */
    setFrame({buffer}) {
        const gl = this.gl, {vertices, faces, edges} = this.mesh;
        let first = 0;
        this.textures.forEach((t, k) => {
            const size = [4 * vertices, faces, edges][k];
            t.data.set(new Float32Array(buffer, 4 * first, size));
            first += size;
            gl.bindTexture(gl.TEXTURE_2D, t.texture);
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ROW, t.rows, k ? gl.RED : gl.RGBA, gl.FLOAT, t.data);
        });
        this.answer({is: 'back', buffer}, [buffer]);
    }

    /* Pairs of numbers, {vertex, kind}, one of each disc: see Drawing.setPoints. */
    setPoints({pairs}) {
        this.discs = pairs.length / 2;
        this.fill('disc', pairs, this.gl.DYNAMIC_DRAW);
    }

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

    /* scene: {width, height, ratio, camera, eye, colours, telling, marked, pixels}, see Drawing.draw. */
    draw({scene}) {
        this.drawAll(scene);
        const {gl} = this, fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl.flush();
        const look = () => {
            if (fence && !gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED)
                return setTimeout(look, 2);
            gl.deleteSync(fence);
            this.answer({is: 'drawn'});
        };
        setTimeout(look, 0);
    }

    drawAll({width, height, ratio, camera, eye, colours: c, telling, marked, pixels}) {
        const {gl, canvas} = this;
        if (canvas.width !== width || canvas.height !== height) canvas.width = width, canvas.height = height;
        gl.viewport(0, 0, width, height);
        gl.clearColor(...c.background, 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        if (!this.mesh) return;
        const shared = {camera, screen: [width, height], eye, flatColour: c.flat, middleColour: c.middle,
            warnColour: c.warn};
        const byForce = Number(telling === 'forces'), byLength = Number(telling === 'lengths');
        gl.enable(gl.DEPTH_TEST);
        gl.disable(gl.BLEND);
        gl.enable(gl.POLYGON_OFFSET_FILL);
        gl.polygonOffset(1, 1);
        this.use('face', {...shared, handleColour: c.handle, marked});
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
        if (this.discs) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.discs);
        gl.depthMask(true);
    }
}

/* As a worker: tells whether it can draw, and then gets the canvas as its first message. */
if (typeof document === 'undefined') {
    let painter = null;
    onmessage = ({data}) => {
        if (data.canvas) painter = new Painter(data.canvas, (message, transfer) => postMessage(message, transfer));
        else painter[data.does](data);
    };
    postMessage(typeof OffscreenCanvas === 'function' && new OffscreenCanvas(1, 1).getContext('webgl2') !== null);
}
