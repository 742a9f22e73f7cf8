/* lessons.js - six short lessons: a sentence, a thing to try, and what to notice once it was done. `done` is asked
   whenever something has happened, {what: 'verdict' (with good, after: 'solve' or 'release', iterations), 'flown'}, and
   keeps what it needs in `memory`; `page` tells how things stand. `example` and `section` are where to read on. */
'use strict';

const short = x => x.toExponential(0);
const isSolved = event => event.what === 'verdict' && event.after === 'solve' && event.good;

const lessons = [
    {
        title: 'Why a mesh of quads is rarely flat', example: 'planarize.c', section: '>>api-measure',
        mesh: 'Flat sheet', rules: {}, reach: 0,
        text: 'Three points always lie in a plane. A fourth does so by chance only, and a panel of glass has four.',
        task: 'Nothing must hold here. Pull one vertex in the middle of the sheet up.',
        done: (event, memory, page) => event.what === 'verdict' && event.after === 'release' && page.warped() > 0,
        notice: (memory, page) => `${page.warped()} of 192 panels are warped, those around the vertex: one corner of ` +
            'each has left the plane of the other three. Undo, tick “Panels are flat” and “Corners stay”, and pull ' +
            'again.',
    },
    {
        title: 'Quadratic by new variables', example: 'custom_constraint.c', section: '>>api-system',
        mesh: 'Roof', rules: {planar: 1, fixedCorners: 1}, slow: true,
        text: '“This quad is flat” is a cubic equation in its corners. With the unit normal n of the panel as three ' +
            'more variables, n·(vᵢ − vⱼ) = 0 and n·n = 1 are quadratic, and Newton’s steps double the digits.',
        task: 'Solve, and watch the bars beside the verdict: one for each iteration, the higher the more digits.',
        done: isSolved,
        notice: (memory, page) => 'What the worst panel lacks after each step: ' +
            `${page.history().map(short).join(', ')} mean edges. Near the end the digits double, until only rounding ` +
            'is left.',
    },
    {
        title: 'Fewer equations than unknowns', example: 'planarize_compare.c', section: '>>loop',
        mesh: 'Roof', rules: {planar: 1, fixedCorners: 1}, epsilon: 0.01,
        text: 'A mesh of quads has 6 unknowns for each panel and 5 equations, one of which follows from the others: ' +
            'many meshes are flat. Each step dx takes a near one, because ε² |dx|² is added to what is made smallest.',
        task: 'Solve with the epsilon 0.01 that is set under Steps. Undo, set it back to auto, and solve again.',
        done(event, memory, page) {
            if (isSolved(event)) memory[page.epsilon() ? 'constant' : 'auto'] = event.iterations;
            return memory.constant > 0 && memory.auto > 0;
        },
        notice: memory => `${memory.constant} iterations with a constant epsilon, ${memory.auto} with one that ` +
            'follows the residual. Epsilon chooses among the answers, and holds each step back a little: it should ' +
            'shrink with what is left to do.',
    },
    {
        title: 'Wishes fade', example: 'hybrid_fairing.c', section: '>>api-form',
        mesh: 'Roof', rules: {planar: 1, gliding: 1, fairness: 0.1}, slow: true,
        text: 'Among the many flat meshes wishes choose: fair lines, even panels, near the start. A wish that stayed ' +
            'on would be weighed against what must hold, so wishes guide first and then have no weight.',
        task: 'Set “Fair lines” to 0.4 or more under Wished, and solve.',
        done: (event, memory, page) => isSolved(event) && page.weight('fairness') >= 0.4,
        notice: () => 'For six iterations the bars stay low while the roof becomes calm. Then the wish is gone, and ' +
            'the panels become flat to rounding within a few steps. Undo and solve with less to compare.',
    },
    {
        title: 'Forces as variables', example: 'thrust_network.c', section: '>>api-statics',
        mesh: 'Shell', rules: {equilibrium: 1, fixedBoundary: 1}, colour: 'forces',
        text: 'Each edge has one variable more, its force density w: it pushes its ends apart by w (vᵢ − vⱼ). ' +
            'In each vertex these forces balance the weight, which is quadratic, too.',
        task: 'Solve. Then tick “Compression only” and solve again.',
        done: (event, memory, page) => isSolved(event) && page.weight('compression') > 0,
        notice: () => 'No edge is red any more. Shape and forces were found together: the shell moved to where no ' +
            'edge needs to pull, which is w ≥ 0 for each.',
    },
    {
        title: 'When things contradict', example: 'planarize.c', section: '>>verdict',
        mesh: 'Impossible', rules: {planar: 1, fixedBoundary: 1},
        text: 'No middle vertex makes four flat panels inside this twisted boundary. ' +
            'The library says so, and names the groups that work against each other.',
        task: 'Solve, and click the sentence to see the worst place. Then untick one of the two groups that it ' +
            'names, and solve.',
        done(event, memory) {
            if (event.what === 'flown') memory.flown = true;
            if (event.what === 'verdict' && !event.good) memory.bad = true;
            return isSolved(event) && memory.bad && memory.flown;
        },
        notice: () => 'Freed of one group, the other holds to rounding. A verdict is no error: it tells you what to ' +
            'give up.',
    },
];
