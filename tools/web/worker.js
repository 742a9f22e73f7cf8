/* worker.js - one worker with one instance of page.c. The page sends messages {does: name, ...}; answers are {is: name,
   ...}. Frames travel in buffers that the page gives back. A solve runs in pieces of a few milliseconds, so that
   messages get through; what is undone lies here as snapshots. */
'use strict';

const REFUSED = 0, ON_THE_WAY = 2; // see page_move
const FRAME_SECONDS = 0.012, SLOW_MS = 260, UNDO_BYTES = 1 << 28;
let module = null, wasm = null;
let opened = null;               // {text, settings, snapshot, fixed}: what a new instance goes on from
const chosen = {tell: 0, epsilon: 0, slow: false};
let activity = 'none';           // 'none', 'drag', 'release' or 'solve'
let target = null, armed = false; // of a drag; is a turn of work under way?
let frameSize = 0, spare = [];   // of a frame in bytes; frame buffers that are at home
let took = null;                 // {what, ms} of the last grab or move
let undo = [], redo = [];
const channel = new MessageChannel(), decoder = new TextDecoder();

const bytes = (at, length) => new Uint8Array(wasm.memory.buffer, at, length);
function textAt(at) {
    const all = new Uint8Array(wasm.memory.buffer);
    return decoder.decode(all.subarray(at, all.indexOf(0, at)));
}
const sentence = () => textAt(wasm.page_sentence());

function instantiate() {
    const imports = {page: {now: () => performance.now() / 1000}};
    for (const {module: from, name} of WebAssembly.Module.imports(module)) // what the C library would ask of a system
        if (from !== 'page') (imports[from] ||= {})[name] = () => { throw new Error(name); };
    wasm = new WebAssembly.Instance(module, imports).exports;
    wasm.__wasm_call_ctors();
}

/* Copies `data` (bytes) into the block; false: no memory. */
function give(data) {
    const at = wasm.page_block(data.length || 1);
    if (at) bytes(at, data.length).set(data);
    return at !== 0;
}

/* -- what the page sees -- */

function postFrame() {
    const state = {
        is: 'frame', activity, undo: undo.length, redo: redo.length, outcome: wasm.page_outcome(),
        iterations: wasm.page_iterations(), residual: wasm.page_residual(), spoiled: wasm.page_spoiled(),
        held: activity === 'drag' && wasm.page_held() !== 0, buffer: null, tell: chosen.tell, took,
        history: Array.from(new Float64Array(wasm.memory.buffer, wasm.page_history(), wasm.page_steps())),
    };
    took = null;
    if (spare.length > 0 && wasm.page_frame()) {
        state.buffer = spare.pop();
        new Uint8Array(state.buffer).set(bytes(wasm.page_block(0), frameSize));
    } else if (activity === 'none') {
        setTimeout(() => guarded(postFrame), 5); // the last frame must arrive
        return;
    }
    postMessage(state, state.buffer ? [state.buffer] : []);
}

function setFrames(size) {
    frameSize = size;
    spare = [new ArrayBuffer(size), new ArrayBuffer(size)];
}

function postVerdict(after) {
    const named = wasm.page_named() ? Array.from(new Float64Array(wasm.memory.buffer, wasm.page_block(0), 5)) : null;
    postMessage({is: 'verdict', after, sentence: sentence(), outcome: wasm.page_outcome(), spoiled: wasm.page_spoiled(),
        iterations: wasm.page_iterations(), named});
}

/* `text`: the mesh as it was opened, or as OBJ where a curve was filled or a mesh made of another. */
function postMesh(name, item, text) {
    const vertices = wasm.page_vertices(), faces = wasm.page_faces(), edges = wasm.page_edges();
    const triangles = wasm.page_topology(), at = wasm.page_block(0);
    const corners = new Uint32Array(wasm.memory.buffer.slice(at, at + 24 * triangles));
    const ends = new Uint32Array(wasm.memory.buffer.slice(at + 24 * triangles, at + 24 * triangles + 8 * edges));
    setFrames(4 * (4 * vertices + faces + edges));
    postMessage({
        is: 'mesh',
        name,
        item,
        vertices,
        faces,
        edges,
        corners,
        ends,
        text,
        edge: wasm.page_reach(1),
        meanEdge: wasm.page_mean_edge(),
        memory: wasm.memory.buffer.byteLength
    }, [corners.buffer, ends.buffer, text.buffer]);
    postMarks();
}

function postMarks() {
    if (!wasm.page_marks()) return;
    const marks = bytes(wasm.page_block(0), wasm.page_vertices()).slice(), count = wasm.page_pins();
    const pins = Array.from(
        {length: count}, (_, k) => Array.from(new Float64Array(wasm.memory.buffer, wasm.page_block(0) + 40 * k, 5)));
    postMessage({is: 'marks', marks, pins});
}

function written(off) {
    const size = wasm.page_write(off);
    return bytes(wasm.page_block(0), size).slice();
}
/* Has the text no faces, so that quads were made to fill it? */
const isCurve = text => text.byteLength < 1 << 20 && !/^\s*(f\s|\S*OFF)/m.test(decoder.decode(text));

/* -- undo -- */

function snapshot() {
    const count = wasm.page_snapshot();
    return new Float64Array(wasm.memory.buffer.slice(wasm.page_block(0), wasm.page_block(0) + 8 * count));
}
function restore(data) {
    if (give(new Uint8Array(data.buffer))) wasm.page_restore();
}
function remember() {
    undo.push(snapshot());
    redo = [];
    while (undo.length > 1 && undo.length * undo[0].byteLength > UNDO_BYTES) undo.shift();
}
function exchange(from, to) {
    finish();
    if (from.length === 0) return;
    to.push(snapshot());
    restore(from.pop());
    opened.snapshot = snapshot();
    postFrame();
    postMessage({is: 'told', sentence: from === undo ? 'Undone.' : 'Done again.'});
}

/* -- work in turns -- */

function arm() {
    if (armed) return;
    armed = true;
    channel.port2.postMessage(0);
}

/* Ends what is on: a release is taken to its end, a solve stays where it is. */
function finish() {
    if (activity === 'drag') wasm.page_release();
    if (activity === 'drag' || activity === 'release') while (wasm.page_step(0.1)) continue;
    if (activity === 'solve') wasm.page_stop();
    if (activity !== 'none') settle();
}

function settle() {
    activity = 'none';
    target = null;
    opened.snapshot = snapshot();
}

/* The work that was to begin does not. */
function refuse() {
    undo.pop();
    activity = 'none';
    postMessage({is: 'error', sentence: sentence()});
    postFrame();
}

function turn() {
    armed = false;
    if (activity === 'drag') {
        if (!target) return;
        const begun = performance.now(), moved = wasm.page_move(...target);
        took = {what: 'move', ms: performance.now() - begun};
        if (moved === REFUSED) postMessage({is: 'error', sentence: sentence()});
        if (moved === ON_THE_WAY) arm();
        else target = null;
        postFrame();
    } else if (activity === 'solve' || activity === 'release') {
        const more = wasm.page_step(chosen.slow ? 0 : FRAME_SECONDS), after = activity;
        if (!more) {
            settle();
            postVerdict(after);
        }
        postFrame();
        if (more && chosen.slow) setTimeout(arm, SLOW_MS);
        else if (more) arm();
    }
}

const does = {
    start({bytes}) {
        module = new WebAssembly.Module(bytes);
        instantiate();
    },
    /* item: its name in the gallery; corners, diagonals, levels, lift: see page_open; fix: vertices that are fixed. */
    open({source, name, item = '', settings, corners = 0, diagonals = false, levels = 0, lift = 0, fix = []}) {
        const text = new Uint8Array(source instanceof Blob ? new FileReaderSync().readAsArrayBuffer(source) : source);
        if (!give(text)) return postMessage({is: 'error', sentence: 'there is not enough memory'});
        if (!wasm.page_open(text.byteLength, corners, diagonals, levels, lift))
            return postMessage({is: 'error', sentence: `The file ${name} was not opened: ${sentence()}`});
        activity = 'none', undo = [], redo = [];
        const other = isCurve(text) || diagonals || levels || lift ? written(false) : undefined;
        if (other && give(other)) wasm.page_open(other.length, 0, false, 0, 0); // exactly as who saves it will open it
        opened = {text: other ?? text, settings: opened?.settings ?? [], fixed: new Set(fix)};
        if (settings) does.set({settings});
        for (const vertex of fix) wasm.page_fix(vertex, true);
        opened.snapshot = snapshot();
        postMesh(name, item, opened.text.slice());
        postFrame();
    },
    set({settings}) {
        for (const [which, weight] of settings) wasm.page_set(which, weight);
        if (opened) opened.settings = settings;
    },
    tell({which}) {
        chosen.tell = which;
        wasm.page_tell(which);
        if (activity === 'none' && opened) postFrame();
    },
    steps({epsilon, slow}) {
        Object.assign(chosen, {epsilon, slow});
        wasm.page_epsilon(epsilon);
    },
    fix({vertex, on}) {
        wasm.page_fix(vertex, on);
        if (on)
            opened.fixed.add(vertex);
        else
            opened.fixed.delete(vertex);
        postMarks();
    },
    solve({iterations}) {
        finish();
        remember();
        activity = 'solve';
        if (!wasm.page_solve(iterations)) return refuse();
        postFrame(); // the first turn may take long: it analyses
        arm();
    },
    grab({vertex, reach}) {
        finish();
        remember();
        activity = 'drag';
        const begun = performance.now();
        if (!wasm.page_grab(vertex, reach)) return refuse();
        took = {what: 'grab', ms: performance.now() - begun};
        postFrame();
    },
    move({to}) {
        if (activity !== 'drag') return;
        target = to;
        arm();
    },
    release() {
        if (activity !== 'drag') return;
        for (let k = 0; target && k < 20; ++k) turn();
        wasm.page_release();
        activity = 'release';
        arm();
    },
    stop() {
        if (activity === 'none') return;
        const drag = activity !== 'solve';
        wasm.page_stop();
        if (drag) undo.pop();
        settle();
        postFrame();
        postMessage({
            is: 'told',
            sentence: drag ? 'The drag was taken back.' : 'Stopped: the mesh is as the last iteration left it.'
        });
    },
    undo() { exchange(undo, redo); },
    redo() { exchange(redo, undo); },
    write({off}) { postMessage({is: 'text', off, bytes: written(off)}); },
    back({buffer}) {
        if (buffer.byteLength === frameSize) spare.push(buffer);
    },
};

/* After a trap, as when memory has run out, a new instance goes on from the last state that was settled. */
function recover(error) {
    postMessage({is: 'error', sentence: `The work broke off (${error.message}) and went back to where it began.`});
    if (activity !== 'none') undo.pop();
    activity = 'none', target = null;
    if (module) instantiate();
    if (!opened) return;
    does.set({settings: opened.settings});
    wasm.page_tell(chosen.tell);
    wasm.page_epsilon(chosen.epsilon);
    if (!give(opened.text) || !wasm.page_open(opened.text.byteLength, 0, false, 0, 0)) return;
    restore(opened.snapshot);
    for (const vertex of opened.fixed) wasm.page_fix(vertex, true);
    setFrames(frameSize);
    postMarks();
    postFrame();
}
function guarded(work) {
    try {
        work();
    } catch (error) {
        recover(error);
    }
}
channel.port1.onmessage = () => guarded(turn);
onmessage = ({data}) => guarded(() => does[data.does](data));
