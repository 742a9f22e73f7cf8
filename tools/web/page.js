/* page.js - the page's thread: controls, pointer, keys, texts. It computes nothing that takes long: worker.js does, and
   sends frames, and draw.js, in another worker, draws them. */
'use strict';

const $ = id => document.getElementById(id);

/* The rules in the order of `rule` in page.c: what the page calls them, how the command line and C do. `most`: a slider
   gives the weight, or, with `factor`, a factor; wishes have `wish`; `boundary`: it asks for nothing of a closed mesh,
   and the command line refuses it there. */
const rules = [
    {key: 'planar', label: 'Panels are flat', command: '--planar', c: 'gproj_add_planarity(form, 1)'},
    {key: 'circular', label: 'Panels have a circumcircle', command: '--circular', needs: 'planar',
        c: 'gproj_add_circularity(form, 1)'},
    {key: 'conical', label: 'Nodes are conical', command: '--conical', needs: 'planar',
        c: 'gproj_add_conicality(form, 1)'},
    {key: 'equalLengths', label: 'Edges are equally long', command: '--equal-lengths',
        c: 'gproj_add_equal_lengths(form, mesh->edge_count, NULL, 1)'},
    {key: 'equilibrium', label: 'Forces balance the weight', command: '--equilibrium --area-load 1',
        c: 'gproj_add_equilibrium(form, &loads, &supports, 1)'},
    {key: 'compression', label: 'Compression only', command: '--compressive', needs: 'equilibrium',
        excludes: ['tension'], c: 'gproj_add_compression(form, mesh->edge_count, NULL, 1)'},
    {key: 'tension', label: 'Tension only', command: '--tensile', needs: 'equilibrium',
        excludes: ['compression'], c: 'gproj_add_tension(form, mesh->edge_count, NULL, 1)'},
    {key: 'fixedBoundary', label: 'Boundary stays', command: '--fix boundary', boundary: true,
        excludes: ['gliding', 'fixedCorners'], c: 'gproj_add_fixed_boundary(form, 1)'},
    {key: 'fixedCorners', label: 'Corners stay', command: '--fix corners', boundary: true,
        excludes: ['fixedBoundary', 'gliding'], c: 'gproj_add_fixed_corners(form, 1)'},
    {key: 'gliding', label: 'Boundary glides on its curve', command: '--glide boundary', boundary: true,
        excludes: ['fixedBoundary', 'fixedCorners'], c: 'gproj_add_gliding_boundary(form, 1)'},
    {key: 'lifting', label: 'Vertices move in height only', command: '--lifting', c: 'gproj_add_lifting(form, 1)'},
    {key: 'orthogonal', label: 'Right angles at the boundary', command: '--orthogonal-boundary',
        boundary: true, c: 'gproj_add_orthogonal_boundary(form, 1)'},
    {key: 'volume', label: 'Volume', most: 2, step: 0.05, factor: true, command: '--volume',
        c: 'gproj_add_volume(form, FACTOR * gproj_volume(mesh), 1)'},
    {key: 'longest', label: 'Longest edge', most: 2.5, step: 0.05, factor: true, command: '--edge-length', c:
        'gproj_add_length_bounds(form, mesh->edge_count, NULL, 0, FACTOR * gproj_mesh_mean_edge_length(mesh), 1)'},
    {key: 'fixed'},
    {key: 'fairness', label: 'Fair lines', most: 0.5, wish: '--fairness ', c: 'gproj_add_fairness(form, 1)'},
    {key: 'closeness', label: 'Near the start', most: 0.5, wish: '--closeness ', c: 'gproj_add_closeness(form, 1)'},
    {key: 'reference', label: 'Near its surface', most: 0.5, wish: '--reference FILE=',
        c: 'gproj_add_reference(form, surface, 1)'},
    {key: 'tangential', label: 'Even panels', most: 0.5, wish: '--tangential ',
        c: 'gproj_add_tangential_fairness(form, 1)'},
    {key: 'gauss', label: 'Calm normals', most: 0.5, wish: '--gauss ', needs: 'planar',
        c: 'gproj_add_gauss_fairness(form, 1)'},
    {key: 'equalAreas', label: 'Equal areas', most: 0.5, wish: '--equal-areas=', c: 'gproj_add_equal_areas(form, 1)'},
    {key: 'parallelograms', label: 'Parallelograms', most: 2, step: 0.05, wish: '--parallelograms=',
        c: 'gproj_add_parallelograms(form, 1)'},
    {key: 'forceFairness', label: 'Even forces', most: 0.5, wish: '--force-fairness=', needs: 'equilibrium',
        c: 'gproj_add_force_fairness(form, 1)'},
];
const index = Object.fromEntries(rules.map((r, k) => [r.key, k]));
const CONVERGED = 0;

/* What the colours tell, in the order of `tale` in page.c; `low` and `high` are the ends of the ramp. */
const colours = [
    {key: 'planarity', label: 'Planarity of panels', low: 'flat', high: '1 % of an edge'},
    {key: 'forces', label: 'Forces in edges', low: 'tension', high: 'compression'},
    {key: 'bends', label: 'Gauss image: angles', low: '0°', high: '30° and more'},
    {key: 'lengths', label: 'Lengths: utilisation', low: '50 %', high: '100 % of the longest'},
];
const epsilons = [0, 1e-4, 1e-3, 1e-2, 3e-2, 1e-1]; // 0: it follows the residual

const weights = new Array(rules.length).fill(0);
let drawing = null, worker = null, item = '', activity = 'starting';
let opened = {name: '', text: ''}; // the mesh as it was opened
let mesh = null, marks = null, pins = [], selected = -1, hovered = -1, drag = null, saving = null;
let named = null, marked = null; // what the verdict names, and what of it is marked
let dirty = true, unseen = false; // a picture is to be drawn; the mesh has not been seen yet
let pictured = true, linked = true; // the small picture of it and the link to it are there
const lesson = {number: -1, memory: {}, done: false, history: [], event: null};
const times = {grab: [], move: []}; // of the last ones, in milliseconds of the worker

const send = (message, transfer = []) => worker.postMessage(message, transfer);

/* -- words -- */

/* `place`: what the verdict names, as worker.js sends it. */
function say(text, mood, place = null) {
    $('sentence').ariaLive = mood === 'busy' ? 'off' : 'polite'; // numbers that run are not to be read aloud
    $('sentence').textContent = text;
    $('verdict').dataset.mood = mood;
    $('verdict').disabled = !place;
    if (drawing && named !== place) {
        named = place;
        mark(null);
    }
}
const capital = text => text.charAt(0).toUpperCase() + text.slice(1) + (/[.!?]$/.test(text) ? '' : '.');

function showState(state) {
    activity = state.activity;
    document.body.dataset.activity = activity;
    const busy = activity === 'solve' || activity === 'release';
    $('stop').disabled = activity === 'none';
    $('undo').disabled = !state.undo;
    $('redo').disabled = !state.redo;
    if (busy && !state.iterations) say('Setting up.', 'busy');
    else if (busy)
        say(`${activity === 'solve' ? 'Solving' : 'Releasing'}: iteration ${state.iterations}, residual ${
                state.residual.toExponential(1)}.`,
            'busy');
    showCourse(activity === 'drag' ? [] : state.history, busy);
    if (state.took) {
        times[state.took.what].push(state.took.ms);
        if (times[state.took.what].length > 400) times[state.took.what].shift();
    }
    if (activity === 'drag') {
        const held = state.held ? ' The vertex stays behind: what must hold lets it go no farther.' : '';
        say(`Dragging: what must hold is off by ${state.residual.toExponential(1)} mean edges.${held}`, 'busy');
    }
    document.body.dataset.residual = state.residual;
}

/* One bar for each iteration, up to the last 40: its height is the number of digits that hold. */
function showCourse(history, busy) {
    const digits = history.map(r => Math.max(0, Math.min(16, -Math.log10(Math.max(r, 1e-16)))));
    $('course').hidden = history.length === 0;
    $('progress').hidden = !busy;
    lesson.history = history;
    if (!history.length) return;
    const first = digits[0], best = Math.max(...digits);
    $('progress').value = (best - first) / Math.max(1, 13 - first);
    $('course-bars').innerHTML = digits.slice(-40).map(d => `<i style="height:${4 + 6 * d}%"></i>`).join('');
    $('course-scale').textContent = `digits that hold: ${Math.round(digits[digits.length - 1])}`;
    $('course').setAttribute(
        'aria-label', `${history.length} iterations, residual ${history[history.length - 1].toExponential(0)}`);
}

/* -- frames -- */

function paint() {
    requestAnimationFrame(paint); // first: an exception below spoils one picture, not all that follow
    if (!linked && mesh) writeLink();
    if (dirty && !drawing.busy) {
        dirty = false;
        drawing.draw();
        if (drawing.telling === 'bends' && mesh) showGauss();
    } else if (!pictured && mesh?.places) {
        pictured = true;
        thumbnail($('chosen'), mesh.vertices > 30000 ? {points: [], faces: []} : asOpened());
    }
}

/* The mesh as it was opened, for its small picture: as the library has read it, whatever the file's format. Faces that are
   not convex come in pieces; vertices without a face are where another one is. */
function asOpened() {
    const {corners, places} = mesh, faces = Array.from({length: mesh.faces}, () => []), pieces = [];
    for (let k = 0; k < corners.length; k += 6) { // a fan: after its first triangle each adds a corner
        const face = faces[corners[k + 1]], [a, b, c] = [corners[k], corners[k + 2], corners[k + 4]];
        if (!face.length) face.push(a, b, c);
        else if (face[0] === a && face[face.length - 1] === b) face.push(c);
        else pieces.push([a, b, c]);
    }
    const points = Array.from(drawing.used, (used, v) => {
        const k = 4 * (used ? v : corners[0]);
        return Array.from(places.subarray(k, k + 3));
    });
    return {points, faces: faces.concat(pieces)};
}

/* Bars over the ramp: how many panels, or edges, have which colour. */
function showLegend() {
    const told = colours.find(c => c.key === drawing.telling), count = 24, bars = new Array(count).fill(0);
    const ofFaces = told.key === 'planarity' || told.key === 'bends',
          part = {forces: [0.5, 0.5], lengths: [2, -1]}[told.key] || [1, 0];
    for (const value of ofFaces ? drawing.values : drawing.forces)
        bars[Math.max(0, Math.min(count - 1, Math.floor((part[0] * value + part[1]) * count)))]++;
    const most = Math.max(1, ...bars);
    $('bars').innerHTML = bars.map(n => `<i style="height:${n ? 4 + 96 * Math.sqrt(n / most) : 0}%"></i>`).join('');
    $('legend').classList.toggle('forces', told.key === 'forces');
    const high = told.key === 'lengths' && weights[index.longest] ? '100 % of the allowed' : told.high;
    $('scale').innerHTML = `<span>${told.low}</span><span>${high}</span>`;
}

/* The Gauss image, seen as the mesh is: the panels' normals as points of a sphere, those behind it paler. */
function showGauss() {
    const canvas = $('gauss'), context = canvas.getContext('2d'), {corners} = mesh, at = drawing.places;
    const {width, height} = canvas, radius = height / 2 - 6, normals = new Float64Array(3 * mesh.faces);
    for (let k = 0; k < corners.length; k += 6) {
        const a = 4 * corners[k], b = 4 * corners[k + 2], c = 4 * corners[k + 4], n = 3 * corners[k + 1];
        const ux = at[b] - at[a], uy = at[b + 1] - at[a + 1], uz = at[b + 2] - at[a + 2];
        const vx = at[c] - at[a], vy = at[c + 1] - at[a + 1], vz = at[c + 2] - at[a + 2];
        normals[n] += uy * vz - uz * vy;
        normals[n + 1] += uz * vx - ux * vz;
        normals[n + 2] += ux * vy - uy * vx;
    }
    const {right, up, back} = drawing.axes(), style = getComputedStyle(document.documentElement);
    context.clearRect(0, 0, width, height);
    context.strokeStyle = style.getPropertyValue('--hover');
    context.lineWidth = 2;
    context.beginPath();
    context.arc(width / 2, height / 2, radius, 0, 2 * Math.PI);
    context.stroke();
    context.fillStyle = style.getPropertyValue('--accent');
    for (let f = 0; f < 3 * mesh.faces; f += 3) {
        const nx = normals[f], ny = normals[f + 1], nz = normals[f + 2];
        const scale = radius / (Math.hypot(nx, ny, nz) || 1);
        const along = axis => scale * (nx * axis[0] + ny * axis[1] + nz * axis[2]);
        context.globalAlpha = along(back) > 0 ? 0.8 : 0.25;
        context.fillRect(width / 2 + along(right) - 1.5, height / 2 - along(up) - 1.5, 3, 3);
    }
    context.globalAlpha = 1;
}

function showPoints() {
    if (!mesh || !marks) return;
    const points = [];
    for (let v = 0; v < mesh.vertices; ++v)
        if (marks[v] & 2 || weights[index.fixedBoundary] && marks[v] & 1 && mesh.vertices < 3000) points.push([v, 1]);
    if (hovered >= 0) points.push([hovered, 4]);
    if (selected >= 0) points.push([selected, 2]);
    if (marked && marked[3] < 2) // a vertex, or the ends of an edge
        for (const v of marked[3] ? mesh.ends.subarray(2 * marked[4], 2 * marked[4] + 2) : [marked[4]])
            points.push([v, 3]);
    drawing.setPoints(points);
    $('fix').disabled = selected < 0;
    $('free').disabled = pins.length === 0;
    $('fix').textContent = selected >= 0 && marks[selected] & 2 ? 'Free vertex' : 'Fix vertex';
    dirty = true;
}

function hover(vertex) {
    $('canvas').classList.toggle('handle', vertex >= 0);
    if (vertex === hovered) return;
    hovered = vertex;
    showPoints();
}

function select(vertex) {
    selected = vertex;
    showPoints();
}

/* Selects the next vertex with a face, or, with -1, the one before. */
function selectNext(by) {
    if (!mesh) return;
    let vertex = selected < 0 && by < 0 ? 0 : selected;
    do vertex = (vertex + by + mesh.vertices) % mesh.vertices;
    while (!drawing.used[vertex]);
    select(vertex);
}

const answers = {
    mesh(message) {
        mesh = message;
        memorySize = message.memory;
        selected = hovered = -1;
        drawing.setMesh(mesh);
        unseen = true;
        opened = {name: message.name, text: message.text};
        item = message.item;
        showItem();
        showLink();
        $('name').textContent = item || opened.name;
        $('counts').textContent = `${mesh.vertices} vertices, ${mesh.faces} panels`;
        $('counts').title = `${mesh.edges} edges`;
        showCourse([], false);
        say('Nothing has been solved yet.', '');
        document.body.dataset.mesh = opened.name;
    },
    marks(message) {
        marks = message.marks;
        pins = message.pins;
        weights[index.fixed] = pins.length ? 1 : 0;
        showPoints();
    },
    frame(state) {
        if (state.buffer) {
            drawing.setFrame(state.buffer);
            if (unseen) {
                unseen = pictured = false;
                mesh.places = drawing.places.slice();
                Object.assign(drawing.view, {yaw: -1.05, pitch: 0.5});
                fit();
            }
            document.body.dataset.frames = Number(document.body.dataset.frames || 0) + 1;
            dirty = true;
            if (colours[state.tell].key === drawing.telling) showLegend();
        }
        showState(state);
        if (lesson.event && state.buffer && activity === 'none') { // the picture that the verdict is about is there
            happened(lesson.event);
            lesson.event = null;
        }
        if (drag && drag.waiting) drag.waiting = false, follow();
    },
    verdict(message) {
        const good = message.outcome === CONVERGED && !message.spoiled;
        say(capital(message.sentence), good ? 'good' : 'bad', message.named);
        document.body.dataset.verdict = message.sentence;
        lesson.event = {what: 'verdict', good, after: message.after, iterations: message.iterations};
    },
    told(message) { say(message.sentence, ''); },
    error(message) {
        say(capital(message.sentence), 'bad');
        document.body.dataset.error = message.sentence;
    },
    back({buffer}) { send({does: 'back', buffer}, [buffer]); },
    drawn() { drawing.busy = false; },
    restored() {
        drawing.restore();
        dirty = true;
    },
    text(message) {
        if (saving) saving(message.bytes);
        saving = null;
    },
};

/* -- meshes -- */

let memorySize = 0; // of the worker's instance, in bytes

/* source: bytes, which are taken away, or a file, which the worker reads; more: {item, corners, diagonals, levels,
   lift, fix}, see worker.js. The page keeps its mesh until the worker has read the new one, which may be refused. */
function open(name, source, preset = null, more = {}) {
    if (preset) setWeights(preset);
    const settings = weights.map((w, k) => [k, w]), file = source instanceof Blob;
    send({does: 'open', source: file ? source : source.buffer, name, settings, ...more}, file ? [] : [source.buffer]);
}

function openFile(file) {
    if (!file) return;
    if (file.size > 200e6) return say(`${file.name} has more than 200 MB.`, 'bad');
    open(file.name, file);
}

/* The points of an OBJ text of the gallery, and its polygons by numbers from 0, or its first curve. */
function parse(text) {
    const points = [], faces = [];
    for (const line of text.split('\n')) {
        if (line.startsWith('v ')) points.push(line.slice(2).trim().split(/\s+/).map(Number));
        if (/^[fl] /.test(line)) faces.push(line.slice(2).trim().split(/\s+/).map(w => parseInt(w, 10) - 1));
    }
    return {points, faces, curve: /^l /m.test(text)};
}

/* Opens an item of the gallery, with its rules or others. */
function choose(name, preset = null) {
    const chosen = gallery.find(g => g.name === name) || gallery[0], text = chosen.make(),
          {corners, levels, lift} = chosen;
    const fix = chosen.fix ? parse(text).points.flatMap((p, v) => chosen.fix(v, p) ? [v] : []) : [];
    setColour(chosen.colour || 'planarity');
    open(chosen.name.toLowerCase().replace(/ /g, '_') + '.obj', new TextEncoder().encode(text), preset || chosen.rules,
        {item: chosen.name, corners, levels, lift, fix});
}

/* Opens a mesh made of this one; more: how, see worker.js. */
async function remake(ending, more) {
    const bytes = await writeMesh();
    if (mesh.faces > 20000) return say('That would be more than a page can show.', 'bad');
    open(opened.name.replace(/(_fine|_diagonals)*\.\w+$/, '') + ending, bytes, null, more);
}

function showItem() {
    for (const button of document.querySelectorAll('#gallery button'))
        button.setAttribute('aria-pressed', String(button.dataset.name === item));
    const chosen = gallery.find(g => g.name === item);
    $('hint').textContent = chosen && lesson.number < 0 ? chosen.hint : '';
}

/* -- small pictures: seen as the mesh is at first, painted from the back -- */

function thumbnail(canvas, {points, faces, curve = false}) {
    const context = canvas.getContext('2d'), {width, height} = canvas;
    context.clearRect(0, 0, width, height);
    if (!points.length) return;
    const seen = points.map(
        ([x, y, z]) => [0.867 * x + 0.498 * y, -0.239 * x + 0.416 * y - 0.878 * z, 0.437 * x - 0.761 * y + 0.479 * z]);
    const range = k => [Math.min(...seen.map(p => p[k])), Math.max(...seen.map(p => p[k]))], [left, right] = range(0),
          [top, bottom] = range(1);
    const scale = Math.min(0.86 * width / (right - left || 1), 0.82 * height / (bottom - top || 1));
    const at = seen.map(([x, y]) => [width / 2 + scale * (x - (left + right) / 2),
        height / 2 + scale * (y - (top + bottom) / 2)]);
    const tone = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const path = face => {
        face.forEach((v, k) => context[k ? 'lineTo' : 'moveTo'](...at[v]));
        context.closePath();
    };
    const [fill, line] = ['--flat', '--line'].map(tone), few = Math.sqrt(width * height / Math.max(1, faces.length));
    const deep = face => face.reduce((sum, v) => sum + seen[v][2], 0) / face.length;
    context.lineWidth = curve ? 2 : Math.min(1, few / 12);
    context.strokeStyle = curve ? tone('--accent') : line;
    context.fillStyle = fill;
    if (faces.length > 3000) { // lines would cover it, and a path of so many takes too long
        context.fillStyle = tone('--bar');
        for (const [x, y] of at) context.fillRect(x - 1.5, y - 1.5, 3, 3);
        return;
    }
    for (const [face] of faces.map(f => [f, deep(f)]).sort((a, b) => a[1] - b[1])) {
        context.beginPath();
        path(face);
        if (!curve) context.fill();
        context.stroke();
    }
}

function makeShelf() {
    let group = '';
    for (const {name, figure, group: of} of gallery) {
        if (of !== group) $('gallery').append(Object.assign(document.createElement('h3'), {textContent: group = of}));
        const button = document.createElement('button'), canvas = document.createElement('canvas'),
              text = document.createElement('span');
        Object.assign(canvas, {width: 240, height: 180});
        canvas.setAttribute('aria-hidden', 'true');
        text.textContent = name;
        button.dataset.name = name;
        button.append(canvas, text);
        if (figure)
            button.append(Object.assign(document.createElement('small'),
                {textContent: figure.includes('.') ? `§ ${figure}` : `Fig. ${figure}`}));
        button.onclick = () => {
            $('shelf').close();
            closeLesson();
            choose(name);
        };
        $('gallery').append(button);
    }
}

function showShelf() {
    $('shelf').showModal();
    document.querySelector('#gallery [aria-pressed="true"]')?.focus();
    paintShelf();
}

/* Paints what is not painted yet, one picture at a time. */
function paintShelf() {
    const button = [...document.querySelectorAll('#gallery button')].find(b => !b.dataset.painted);
    if (!button || !$('shelf').open) return;
    button.dataset.painted = 'yes';
    thumbnail(button.querySelector('canvas'), parse(gallery.find(g => g.name === button.dataset.name).make()));
    requestAnimationFrame(paintShelf);
}

function download(name, bytes) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes], {type: 'text/plain'}));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/* The mesh as it is, as OBJ: bytes. */
function writeMesh() {
    return new Promise(resolve => {
        saving = resolve;
        send({does: 'write', off: false});
    });
}

/* -- rules -- */

function setWeights(preset) {
    rules.forEach((r, k) => { weights[k] = r.key === 'fixed' ? weights[k] : preset[r.key] || 0; });
    showRules();
}

function showRules() {
    rules.forEach((r, k) => {
        if (!r.input) return;
        if (r.most)
            r.input.value = weights[k],
            r.output.value = weights[k] ? `${r.factor ? '×' : ''}${weights[k].toFixed(2)}` : 'off';
        else r.input.checked = weights[k] > 0;
    });
    showLink();
}

/* What the page shows, as the hash of its address: written with the next picture, because browsers do
   not like it often. */
function showLink() { linked = false; }
function writeLink() {
    linked = true;
    const parts = rules.filter((r, k) => r.label && weights[k]).map(r => `${r.key}=${weights[index[r.key]]}`);
    if (item) parts.unshift(`mesh=${encodeURIComponent(item)}`);
    if (drawing.telling !== 'planarity') parts.push(`colour=${drawing.telling}`);
    if (epsilon()) parts.push(`epsilon=${epsilon()}`);
    if (lesson.number >= 0) parts.push(`lesson=${lesson.number + 1}`);
    if (location.hash !== '#' + parts.join('&')) history.replaceState(null, '', '#' + parts.join('&'));
}

/* Opens what a hash says. */
function follows(hash) {
    const wanted = new URLSearchParams(hash.slice(1)), number = Number(wanted.get('lesson'));
    setSteps(Number(wanted.get('epsilon')) || 0, false);
    if (number >= 1 && number <= lessons.length) return openLesson(number - 1);
    closeLesson();
    const preset = {};
    for (const [key, weight] of wanted) if (key in index) preset[key] = Math.max(0, Math.min(2.5, Number(weight) || 0));
    choose(wanted.get('mesh'), wanted.get('mesh') ? preset : null);
    if (colours.some(c => c.key === wanted.get('colour'))) setColour(wanted.get('colour'));
}

function setRule(key, weight) {
    const rule = rules[index[key]];
    weights[index[key]] = weight;
    if (weight && rule.needs) weights[index[rule.needs]] ||= 1;
    if (weight) for (const other of rule.excludes || []) weights[index[other]] = 0;
    if (!weight) rules.forEach((r, k) => { if (r.needs === key) weights[k] = 0; });
    if (key === 'equilibrium') setColour(weight ? 'forces' : 'planarity');
    if (key === 'longest' && weight) setColour('lengths');
    showRules();
    showPoints();
    send({does: 'set', settings: weights.map((w, k) => [k, w])});
}

function setColour(which) {
    drawing.telling = which;
    $('colour').value = which;
    $('gauss').hidden = which !== 'bends';
    if (worker) send({does: 'tell', which: colours.findIndex(c => c.key === which)});
    showLink();
}

const epsilon = () => epsilons[Number($('epsilon').value)];
function setSteps(wanted, slow) {
    $('epsilon').value = Math.max(0, epsilons.indexOf(wanted));
    $('epsilon-value').value = epsilon() || 'auto';
    $('slow').checked = slow;
    send({does: 'steps', epsilon: epsilon(), slow});
    showLink();
}

function setTheme(theme) {
    document.documentElement.dataset.theme = theme;
    $('theme').setAttribute('aria-pressed', String(theme === 'dark'));
    for (const button of document.querySelectorAll('#gallery button')) delete button.dataset.painted;
    if (!drawing) return;
    drawing.readColours();
    pictured = !mesh;
    dirty = true;
}

/* -- lessons -- */

/* What a lesson may ask. */
const standing = {
    warped: () => drawing.telling === 'planarity' ? drawing.values.filter(v => v > 0.25).length : 0,
    history: () => lesson.history,
    epsilon,
    weight: key => weights[index[key]],
};

function openLesson(number) {
    const {
        title,
        text,
        task,
        mesh: name,
        rules: preset,
        colour,
        reach = 5,
        slow = false,
        epsilon = 0,
        example,
        section
    } = lessons[number];
    Object.assign(lesson, {number, memory: {}, done: false, event: null});
    $('lesson').hidden = false;
    document.body.dataset.lesson = number + 1;
    $('lesson').classList.remove('done');
    $('lesson-number').textContent = `Lesson ${number + 1} of ${lessons.length}`;
    $('lesson-title').textContent = title;
    $('lesson-text').textContent = text;
    $('lesson-try').textContent = task;
    $('lesson-notice').textContent = '';
    /* In the repository, where the page was made, the files are beside it. */
    const beside = /\/tools\/web\/build\/[^/]*$/.test(location.pathname),
          file = (path, words) => beside ? `<a href="../../../${path}" target="_blank">${words}</a>` : words;
    $('lesson-links').innerHTML = `Read on: ${file(`examples/${example}`, `examples/${example}`)}; ${section} in ${
        file('guidedproj.h', 'guidedproj.h')}`;
    $('lesson-back').disabled = number === 0;
    $('lesson-next').textContent = number + 1 < lessons.length ? 'Next' : 'Done';
    $('reach').value = reach;
    showReach();
    setSteps(epsilon, slow);
    choose(name, preset);
    setColour(colour || 'planarity');
}

function closeLesson() {
    if (lesson.number < 0) return;
    lesson.number = -1;
    $('lesson').hidden = true;
    delete document.body.dataset.lesson;
    setSteps(epsilon(), false);
    showItem();
}

/* Tells the lesson that is open what has happened. */
function happened(event) {
    if (lesson.number < 0 || lesson.done) return;
    const {done, notice} = lessons[lesson.number];
    if (!done(event, lesson.memory, standing)) return;
    lesson.done = true;
    $('lesson').classList.add('done');
    $('lesson-notice').textContent = notice(lesson.memory, standing);
}

/* -- actions -- */

function solve() { send({does: 'solve', iterations: 300}); }
function stop() { drag = null; send({does: 'stop'}); }

function toggleFixed() {
    if (selected < 0) return;
    marks[selected] ^= 2;
    send({does: 'fix', vertex: selected, on: (marks[selected] & 2) !== 0});
    showPoints();
}
function freeAll() {
    for (const [vertex] of pins) send({does: 'fix', vertex, on: false});
}

function showReach() { $('reach-value').value = Number($('reach').value) || 'off'; }
const reach = () => Number($('reach').value) * mesh.edge;

/* Sends the drag's target, one at a time: the next one when the frame of the last one is there. */
function follow() {
    if (!drag || !drag.target || drag.waiting) return;
    send({does: 'move', to: drag.target});
    drag.target = null;
    drag.waiting = true;
}

function nudge(dx, dy, dz) {
    if (selected < 0 || activity === 'drag') return;
    const {right, up} = drawing.axes(), step = 0.25 * mesh.edge;
    const to = drawing.place(selected).map((p, k) => p + step * (dx * right[k] + dy * up[k] + (k === 2 ? dz : 0)));
    send({does: 'grab', vertex: selected, reach: reach()});
    send({does: 'move', to});
    send({does: 'release'});
}

/* -- the view -- */

/* The width that a lesson takes of the canvas: the mesh is shown beside it. */
const inset = () => $('lesson').hidden || innerWidth <= 760 ? 0 : $('lesson').offsetWidth;

/* Shows the whole mesh: the view's axes stay, distance and target follow from where the vertices appear. */
function fit() {
    const {view, canvas} = drawing, {right, up} = drawing.axes();
    Object.assign(view, {distance: 5, target: [0, 0, 0]});
    for (let round = 0; round < 5; ++round) {
        const [low, high] = drawing.extent();
        const size = [canvas.clientWidth - inset(), canvas.clientHeight], scale = drawing.pixel(view.distance);
        const off = [0, 1].map(k => scale * ((low[k] + high[k]) / 2 - size[k] / 2 - (k ? 0 : inset())));
        view.target = view.target.map((t, k) => t + off[0] * right[k] - off[1] * up[k]);
        view.distance *= Math.max((high[0] - low[0]) / (0.84 * size[0]), (high[1] - low[1]) / (0.74 * size[1]), 0.1);
    }
    dirty = true;
}

function orbit(dx, dy) {
    drawing.view.yaw -= dx;
    drawing.view.pitch = Math.max(-1.55, Math.min(1.55, drawing.view.pitch + dy));
    dirty = true;
}

function zoom(factor) {
    drawing.view.distance = Math.max(0.15, Math.min(40, drawing.view.distance * factor));
    dirty = true;
}

function pan(dx, dy) {
    const {right, up} = drawing.axes(), scale = drawing.pixel(drawing.view.distance), {target} = drawing.view;
    for (let k = 0; k < 3; ++k) target[k] += scale * (-dx * right[k] + dy * up[k]);
    dirty = true;
}

/* Marks what a verdict has named: a face, or vertices. */
function mark(place) {
    marked = place;
    drawing.marked = place && place[3] === 2 ? place[4] : -1;
    showPoints();
}

/* Flies to what the verdict names, and marks it. */
function showNamed() {
    if (!named) return;
    mark(named);
    fly(named);
    happened({what: 'flown'});
}

/* Moves the view to a place, in a few pictures, or in one where motion is not wanted. */
function fly(place, count = matchMedia('(prefers-reduced-motion: reduce)').matches ? 1 : 18) {
    const {view} = drawing, {right} = drawing.axes(), from = view.target.slice(), distance = view.distance,
          near = Math.min(distance, Math.max(0.3, 14 * mesh.edge));
    const to = place.slice(0, 3).map((p, k) => p - drawing.pixel(near) * inset() / 2 * right[k]);
    let n = 0;
    const next = () => {
        const t = ++n / count, s = t * t * (3 - 2 * t);
        view.target = from.map((f, k) => f + s * (to[k] - f));
        view.distance = distance + s * (near - distance);
        dirty = true;
        if (n < count) requestAnimationFrame(next);
    };
    next();
}

/* -- pointers: one on a vertex drags it, one elsewhere turns the view, two move and zoom it -- */

function listenToPointers(canvas) {
    const pointers = new Map();
    const at = event => {
        const box = canvas.getBoundingClientRect();
        return [event.clientX - box.left, event.clientY - box.top];
    };
    canvas.addEventListener('pointerdown', event => {
        const [x, y] = at(event);
        canvas.setPointerCapture(event.pointerId);
        canvas.focus({preventScroll: true});
        pointers.set(event.pointerId, {x, y});
        if (pointers.size > 1 || event.button === 2 || event.shiftKey) {
            if (drag) release();
            return;
        }
        const vertex = drawing.pick(x, y, event.pointerType === 'touch');
        select(vertex);
        if (vertex < 0) return;
        const place = drawing.place(vertex), w = drawing.project(place)[2];
        drag = {
            vertex,
            x,
            y,
            place,
            scale: drawing.pixel(w),
            axes: drawing.axes(),
            begun: false,
            waiting: false,
            target: null
        };
    });
    canvas.addEventListener('pointermove', event => {
        const [x, y] = at(event), before = pointers.get(event.pointerId);
        if (!before) {
            hover(drawing.pick(x, y, false));
            return;
        }
        const dx = x - before.x, dy = y - before.y;
        if (pointers.size === 2) {
            const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
            zoom(
                Math.hypot(before.x - other.x, before.y - other.y) / Math.max(1, Math.hypot(x - other.x, y - other.y)));
            pan(dx / 2, dy / 2);
        } else if (drag) {
            pull(x, y, event.altKey);
        } else if (event.buttons === 2 || event.shiftKey) {
            pan(dx, dy);
        } else {
            orbit(0.008 * dx, 0.008 * dy);
        }
        Object.assign(before, {x, y});
    });
    const up = event => {
        pointers.delete(event.pointerId);
        if (drag) release();
    };
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('pointerleave', () => hover(-1));
    canvas.addEventListener('dblclick', event => {
        select(drawing.pick(...at(event), false));
        toggleFixed();
    });
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    canvas.addEventListener('wheel', event => {
        event.preventDefault();
        zoom(Math.exp(0.0012 * event.deltaY));
    }, {passive: false});
}

/* The pointer has dragged the vertex to (x, y): in the plane of the screen, with Alt up and down only. */
function pull(x, y, upright) {
    const dx = x - drag.x, dy = y - drag.y, {right, up} = drag.axes;
    if (!drag.begun) {
        if (Math.hypot(dx, dy) < 3) return;
        drag.begun = true;
        $('canvas').classList.add('dragging');
        send({does: 'grab', vertex: drag.vertex, reach: reach()});
    }
    drag.target = drag.place.map((p, k) =>
        p + drag.scale * (upright ? (k === 2 ? -dy : 0) : dx * right[k] - dy * up[k]));
    follow();
}

function release() {
    if (drag.begun) {
        if (drag.target) send({does: 'move', to: drag.target});
        send({does: 'release'});
    }
    drag = null;
    $('canvas').classList.remove('dragging');
}

/* -- keys -- */

const keys = {
    ArrowLeft: () => selected < 0 ? orbit(-0.1, 0) : nudge(-1, 0, 0),
    ArrowRight: () => selected < 0 ? orbit(0.1, 0) : nudge(1, 0, 0),
    ArrowUp: () => selected < 0 ? orbit(0, 0.1) : nudge(0, 1, 0),
    ArrowDown: () => selected < 0 ? orbit(0, -0.1) : nudge(0, -1, 0),
    PageUp: () => nudge(0, 0, 1),
    PageDown: () => nudge(0, 0, -1),
    n: () => selectNext(1),
    p: () => selectNext(-1),
    f: toggleFixed,
    s: solve,
    '+': () => zoom(0.9),
    '-': () => zoom(1 / 0.9),
};

function listenToKeys() {
    document.addEventListener('pointerdown', () => { document.body.dataset.by = 'pointer'; });
    document.addEventListener('keydown', event => {
        document.body.dataset.by = 'keys';
        if ($('dialog').open || $('shelf').open) return;
        if (event.key === 'Escape') {
            if (activity === 'none') select(-1);
            else stop();
        } else if (event.ctrlKey || event.metaKey) {
            const key = event.key.toLowerCase(), back = key === 'z' && !event.shiftKey;
            if (!back && key !== 'y' && key !== 'z') return;
            send({does: back ? 'undo' : 'redo'});
            event.preventDefault();
        } else if (keys[event.key] && (event.target === $('canvas') || event.key === 's')) {
            keys[event.key]();
            event.preventDefault();
        }
    });
}

/* -- the same elsewhere: a program and a command that open the mesh as it was opened here and solve it so -- */

const fixedList = () => pins.filter(pin => !pin[4]).map(pin => pin[0]);
const movedList = () => pins.filter(pin => pin[4]); // fixed, but elsewhere than in the file
const isOn = key => weights[index[key]] > 0;
const isClosed = () => !marks.some(m => m & 1);
const asked = () => rules.filter((r, k) => weights[k] && r.label && !(r.boundary && isClosed()));
const unsupported = () => isOn('equilibrium') && isClosed() && pins.length === 0;

/* A file's name as a word of the shell, and as a string in C. */
const shellWord = name => /^[\w.+-]+$/.test(name) && name[0] !== '-' ? name : `'./${name.replace(/'/g, "'\\''")}'`;
const octal = c => '\\' + c.charCodeAt(0).toString(8).padStart(3, '0'); // of a control character
const cString = name => `"${name.replace(/["\\?]/g, '\\$&').replace(/[\0-\x1f\x7f]/g, octal)}"`;

function asCommand() {
    const parts = ['tools/guidedproj', shellWord(opened.name), '-o solved.obj'], pinned = fixedList();
    for (const r of asked()) {
        const w = weights[index[r.key]];
        if (r.wish) parts.push(r.wish.replace('FILE', () => shellWord(opened.name)) + w); // `$&` is no pattern in it
        else if (r.key === 'volume') parts.push(`--volume x${w}`);
        else if (r.key === 'longest') parts.push(`--edge-length ,${w * mesh.meanEdge}`);
        else parts.push(r.command);
    }
    if (isOn('equilibrium') && isClosed() && pins.length) parts.push(`--supports ${pins.map(pin => pin[0]).join(',')}`);
    if (pinned.length) parts.push(`--fix ${pinned.join(',')}`);
    for (const [vertex, x, y, z] of movedList()) parts.push(`--move ${vertex},${x},${y},${z}`);
    if (epsilon()) parts.push(`--epsilon ${epsilon()}`);
    return parts.join(' ') + '\n';
}

/* Lines of numbers as a C array. */
function cArray(type, name, numbers) {
    const lines = [''];
    for (const word of numbers.map(String)) {
        if (lines[lines.length - 1].length + word.length > 96) lines.push('');
        lines[lines.length - 1] += `${lines[lines.length - 1] ? ' ' : ''}${word},`;
    }
    return `    static const ${type} ${name}[] = {\n        ${lines.join('\n        ')}\n    };`;
}

function asProgram() {
    const fixed = fixedList(), moved = movedList(), lines = [], supports = isOn('equilibrium'),
          surface = isOn('reference');
    const out = (...more) => lines.push(...more);
    out('/* Build and run: cc -O2 -I. solve.c -lm -o solve && ./solve */', '#define GUIDEDPROJ_IMPLEMENTATION',
        '#include "guidedproj.h"', '#include <stdio.h>', '#include <stdlib.h>', '', 'int main(void) {',
        '    gproj_error error;', `    gproj_mesh *mesh = gproj_mesh_load(${cString(opened.name)}, NULL, &error);`,
        '    if (!mesh) return puts(error.message), 1;', '    gproj_form *form = gproj_form_create(mesh, NULL);',
        `    gproj_solve_options options = {.smooth = true${epsilon() ? `, .epsilon = ${epsilon()}` : ''}};`);
    if (surface) out('    gproj_surface *surface = gproj_surface_create(mesh, NULL, &error);');
    if (unsupported()) {
        out('    gproj_loads loads = {.area_load = 1};', '    gproj_supports supports = {0, NULL, NULL};');
    } else if (supports && isClosed()) {
        out('    /* Panels weigh 1 per area; fixed vertices carry. */', '    gproj_loads loads = {.area_load = 1};',
            cArray('int32_t', 'support', pins.map(pin => pin[0])),
            `    gproj_supports supports = {${pins.length}, support, NULL};`);
    } else if (supports) {
        out('    /* Panels weigh 1 per area; the boundary carries. */', '    gproj_loads loads = {.area_load = 1};',
            '    int32_t *boundary = malloc(sizeof *boundary * (size_t)mesh->vertex_count);', '    int32_t count = 0;',
            '    for (int32_t v = 0; v < mesh->vertex_count; ++v)',
            '        if (gproj_mesh_is_boundary_vertex(mesh, v)) boundary[count++] = v;',
            '    gproj_supports supports = {count, boundary, NULL};');
    }
    if (fixed.length) out(cArray('int32_t', 'fixed', fixed));
    if (moved.length)
        out(cArray('int32_t', 'moved', moved.map(pin => pin[0])),
            cArray('double', 'places', moved.flatMap(pin => pin.slice(1, 4))));
    for (const r of asked()) {
        const w = weights[index[r.key]];
        if (r.wish) out(`    gproj_set_schedule(form, ${r.c}, gproj_fade(${w}, ${supports ? 9 : 6}));`);
        else out(`    ${r.c.replace('FACTOR', w)};`);
    }
    if (fixed.length) out(`    gproj_add_fixed(form, ${fixed.length}, fixed, 1);`);
    if (moved.length) out(`    gproj_add_targets(form, ${moved.length}, moved, places, 1);`);
    out('    gproj_result result = gproj_solve(form, 300, &options);', '    puts(result.message);',
        '    if (result.outcome != GPROJ_FAILED) gproj_mesh_save(mesh, "solved.obj", &error);',
        '    gproj_form_destroy(form);');
    if (surface) out('    gproj_surface_destroy(surface);');
    out('    gproj_mesh_destroy(mesh);');
    if (supports && !isClosed()) out('    free(boundary);');
    out('    return result.outcome != GPROJ_CONVERGED;', '}');
    return lines.join('\n') + '\n';
}

function show(title, note, text) {
    $('dialog-title').textContent = title;
    $('dialog-note').textContent = note;
    $('code').textContent = text;
    $('save-opened').hidden = text.startsWith('file:') || text.startsWith('http');
    $('dialog').showModal();
}

/* Copies the text, or, where the browser does not let it, selects it. */
function copy() {
    const told = words => {
        $('copy').textContent = words;
        setTimeout(() => { $('copy').textContent = 'Copy'; }, 1500);
    };
    getSelection().selectAllChildren($('code'));
    (navigator.clipboard?.writeText($('code').textContent) ?? Promise.reject())
        .then(() => told('Copied'), () => told('Selected'));
}

/* -- beginning -- */

function makeControls() {
    makeShelf();
    for (const {key, label} of colours)
        $('colour').append(Object.assign(document.createElement('option'), {value: key, textContent: label}));
    for (const rule of rules) {
        if (!rule.label) continue;
        const label = document.createElement('label'), input = document.createElement('input'),
              text = document.createElement('span');
        text.textContent = rule.label;
        rule.input = input;
        if (rule.most) {
            Object.assign(input, {type: 'range', min: 0, max: rule.most, step: rule.step || 0.01, value: 0});
            rule.output = document.createElement('output');
            label.className = 'slider';
            label.append(text, input, rule.output);
            input.oninput = () => setRule(rule.key, Number(input.value));
        } else {
            input.type = 'checkbox';
            label.className = 'check';
            label.append(input, text);
            input.onchange = () => setRule(rule.key, input.checked ? 1 : 0);
        }
        input.id = 'rule-' + rule.key;
        $(rule.wish ? 'wishes' : 'holds').append(label);
    }
    $('solve').onclick = solve;
    $('stop').onclick = stop;
    $('undo').onclick = () => send({does: 'undo'});
    $('redo').onclick = () => send({does: 'redo'});
    $('verdict').onclick = showNamed;
    $('open').onclick = () => $('file').click();
    $('file').onchange = event => { openFile(event.target.files[0]); event.target.value = ''; };
    $('save').onclick = async () => download(opened.name.replace(/\.\w+$/, '') + '_solved.obj', await writeMesh());
    $('fix').onclick = toggleFixed;
    $('fit').onclick = fit;
    $('free').onclick = freeAll;
    $('subdivide').onclick = () => remake('_fine.obj', {levels: 1});
    $('diagonals').onclick = () => remake('_diagonals.obj', {diagonals: true});
    $('reach').oninput = showReach;
    showReach();
    $('colour').onchange = () => setColour($('colour').value);
    $('epsilon').oninput = $('slow').onchange = () => setSteps(epsilon(), $('slow').checked);
    $('choose').onclick = showShelf;
    $('shelf-close').onclick = () => $('shelf').close();
    $('theme').onclick = () => setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
    $('lessons').onclick = () => openLesson(Math.max(0, lesson.number));
    $('lesson-close').onclick = closeLesson;
    $('lesson-back').onclick = () => openLesson(lesson.number - 1);
    $('lesson-again').onclick = () => openLesson(lesson.number);
    $('lesson-next').onclick = () => lesson.number + 1 < lessons.length ? openLesson(lesson.number + 1) : closeLesson();
    $('as-link').onclick = () => writeLink() ??
        show('As a link',
            item ? 'Opens this page with this mesh and these settings; what was pulled is not in it.'
                 : 'Opens this page with these settings; a mesh of your own is not in it.',
            location.href);
    const note = () => unsupported() ? 'Nothing carries a closed mesh but vertices that are fixed: fix some first.'
                                     : `Opens ${opened.name}, the mesh as it was opened here, and solves it so.`;
    $('as-c').onclick = () => show('As C', note(), asProgram());
    $('as-command').onclick = () => show('As a command', note(), asCommand());
    $('copy').onclick = copy;
    $('save-opened').onclick = () => download(opened.name, opened.text);
    $('close').onclick = () => $('dialog').close();
}

function listenToDrops(stage) {
    const over = on => event => {
        event.preventDefault();
        stage.classList.toggle('over', on);
    };
    stage.addEventListener('dragover', over(true));
    stage.addEventListener('dragleave', over(false));
    stage.addEventListener('drop', event => {
        over(false)(event);
        openFile(event.dataTransfer.files[0]);
    });
}

/* The module, from base64 and gzip. */
async function unpack() {
    const packed = Uint8Array.from(atob($('wasm').textContent), c => c.charCodeAt(0));
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

const workerOf = source => {
    const made = new Worker(URL.createObjectURL(new Blob([$(source).textContent], {type: 'text/javascript'})));
    made.onerror = event => say(`The worker failed: ${event.message}`, 'bad');
    return made;
};

/* The painter: a worker, or, where workers have no WebGL 2, an object of the page that takes messages as one does. */
async function startPainter(canvas) {
    const made = workerOf('draw.js'), answer = message => answers[message.is](message);
    const able = await new Promise(resolve => { made.onmessage = ({data}) => resolve(data); });
    if (able && canvas.transferControlToOffscreen) {
        const offscreen = canvas.transferControlToOffscreen();
        made.onmessage = ({data}) => answer(data);
        made.postMessage({canvas: offscreen}, [offscreen]);
        return made;
    }
    made.terminate();
    return Object.assign(new Painter(canvas, answer), {postMessage(message) { this[message.does](message); }});
}

async function begin() {
    const darkness = matchMedia('(prefers-color-scheme: dark)');
    setTheme(darkness.matches ? 'dark' : 'light');
    darkness.onchange = () => setTheme(darkness.matches ? 'dark' : 'light');
    makeControls();
    drawing = new Drawing($('canvas'));
    worker = workerOf('worker.js');
    worker.onmessage = ({data}) => answers[data.is](data);
    drawing.painter = await startPainter(drawing.canvas);
    const bytes = await unpack();
    send({does: 'start', bytes}, [bytes]);
    listenToPointers($('canvas'));
    listenToKeys();
    listenToDrops($('stage'));
    new ResizeObserver(() => { dirty = true; }).observe($('canvas'));
    addEventListener('hashchange', () => follows(location.hash));
    follows(location.hash);
    paint();
}
begin().catch(error => say(capital(error.message), 'bad'));
