/* view.js - the view of a mesh in the page's thread: the camera, its colours, which vertex is where on the screen. The
   painter, draw.js, gets from it what it draws. */
'use strict';

/* "#rrggbb" of a custom property, as three numbers in 0..1. */
function colourOf(name) {
    const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    return [1, 3, 5].map(k => parseInt(text.slice(k, k + 2), 16) / 255);
}

class Drawing {
    constructor(canvas) {
        this.canvas = canvas;
        this.painter = null; // takes messages as a worker does; see draw.js
        this.busy = false;   // is a picture on the way?
        this.view = {yaw: -1.05, pitch: 0.5, distance: 4, target: [0, 0, 0]};
        this.telling = 'planarity'; // see `colours` in page.js
        this.marked = -1;           // a face
        this.points = [];
        this.readColours();
    }

    readColours() {
        this.colours = {};
        for (const name of ['background', 'flat', 'middle', 'warn', 'line', 'push', 'pull', 'fixed', 'handle', 'paper'])
            this.colours[name] = colourOf('--' + name);
    }

    /* {vertices, faces, edges, corners, ends, edge} as worker.js sends them. */
    setMesh(mesh) {
        const {vertices, faces, edges, corners, ends} = mesh, parts = [4 * vertices, faces, edges];
        this.mesh = mesh;
        this.frame = new Float32Array(parts[0] + parts[1] + parts[2]);
        this.places = this.frame.subarray(0, parts[0]);
        this.values = this.frame.subarray(parts[0], parts[0] + parts[1]);
        this.forces = this.frame.subarray(parts[0] + parts[1]);
        this.used = new Uint8Array(vertices); // has the vertex a face? Others are not seen, and may be far away
        for (let k = 0; k < corners.length; k += 2) this.used[corners[k]] = 1;
        this.painter.postMessage({does: 'setMesh', mesh: {vertices, faces, edges, corners, ends}});
        this.setPoints([]);
    }

    /* Takes the buffer away; the painter gives it back. Floats: 4 for each vertex, 1 for each face, 1 for each edge. */
    setFrame(buffer) {
        this.frame.set(new Float32Array(buffer));
        this.painter.postMessage({does: 'setFrame', buffer}, [buffer]);
    }

    /* Pairs [vertex, kind] of discs: kind 1 is fixed, 2 is the handle, 3 is named by the verdict, 4 is under the
       pointer. */
    setPoints(points) {
        this.points = points;
        this.painter.postMessage({does: 'setPoints', pairs: new Uint32Array(points.flat())});
    }

    /* Tells a painter that has lost everything. */
    restore() {
        if (!this.mesh) return;
        const {frame, points} = this;
        this.setMesh(this.mesh);
        this.setFrame(frame.buffer);
        this.setPoints(points);
    }

    draw() {
        const {canvas, colours, telling, marked, mesh} = this, ratio = Math.min(2, devicePixelRatio || 1);
        this.busy = true;
        this.painter.postMessage({
            does: 'draw',
            scene: {
                width: Math.round(canvas.clientWidth * ratio),
                height: Math.round(canvas.clientHeight * ratio),
                ratio,
                camera: this.matrix(),
                eye: this.eye(),
                colours,
                telling,
                marked,
                pixels: mesh ? mesh.edge / this.pixel(this.view.distance) : 0 // of a mean edge, on the screen
            }
        });
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
    project(p) {
        const m = this.matrix();
        const [x, y, , w] = [0, 1, 2, 3].map(r => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
        return [(x / w + 1) / 2 * this.canvas.clientWidth, (1 - y / w) / 2 * this.canvas.clientHeight, w];
    }

    /* Where the vertices with a face appear: [[least x, least y], [most x, most y]] in CSS pixels. */
    extent() {
        const m = this.matrix(), p = this.places, low = [Infinity, Infinity], high = [-Infinity, -Infinity];
        for (let k = 0; k < p.length; k += 4) {
            if (!this.used[k / 4]) continue;
            const w = m[3] * p[k] + m[7] * p[k + 1] + m[11] * p[k + 2] + m[15];
            for (let r = 0; r < 2; ++r) {
                const at = (m[r] * p[k] + m[4 + r] * p[k + 1] + m[8 + r] * p[k + 2] + m[12 + r]) / w;
                low[r] = Math.min(low[r], at), high[r] = Math.max(high[r], at);
            }
        }
        return [[low[0], -high[1]], [high[0], -low[1]]].map(
            ([x, y]) => [(x + 1) / 2 * this.canvas.clientWidth, (y + 1) / 2 * this.canvas.clientHeight]);
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
        for (let v = 0, k = 0; v < this.mesh.vertices; ++v, k += 4) {
            if (!this.used[v]) continue;
            const w = m[3] * p[k] + m[7] * p[k + 1] + m[11] * p[k + 2] + m[15];
            const dx = ((m[0] * p[k] + m[4] * p[k + 1] + m[8] * p[k + 2] + m[12]) / w + 1) * width - x;
            const dy = (1 - (m[1] * p[k] + m[5] * p[k + 1] + m[9] * p[k + 2] + m[13]) / w) * height - y;
            const off = Math.sqrt(dx * dx + dy * dy),
                  cost = w + 0.7 * edge * off / radius; // nearer ones first, then those below
            if (off <= radius && cost < least) best = v, least = cost;
        }
        return best;
    }
}
