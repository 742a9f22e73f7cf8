/* editor_loop.c - the skeleton of an editor: each frame takes an event, and what time is left goes to the solver.

   What a plug-in or a game editor does with the library, without its graphics: a solve that goes on a few milliseconds a
   frame, a drag that follows the mouse, escape, undo and redo. Events come from a script. What they lead to does not
   depend on how long frames are. Writes editor_start.obj and editor_loop.obj.

   Build and run:   cc -O2 editor_loop.c -lm -o editor_loop && ./editor_loop
   Prints:          a line for each event, and where it has led to */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "grid.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIDE = 24,
    ACROSS = SIDE + 1,
    HANDLE = 9 * ACROSS + 14,
    STATES = 16
};

static const double frame_seconds = 0.004; /* what drawing leaves of a sixtieth of a second */

typedef struct editor {
    gproj_mesh *mesh;
    gproj_form *form;
    gproj_drag *drag; /* under way, or NULL */
    void *state[STATES];
    size_t size[STATES];
    int now, last; /* of the states */
} editor;

/* Makes the present the next state; what could have been redone is forgotten. */
static void remember(editor *e) {
    e->now = e->now + 1 < STATES ? e->now + 1 : 1;
    free(e->state[e->now]);
    e->size[e->now] = gproj_state_size(e->form);
    e->state[e->now] = malloc(e->size[e->now]);
    if (e->state[e->now]) gproj_state_save(e->form, e->state[e->now], e->size[e->now], NULL);
    e->last = e->now;
}

static void go_to(editor *e, int number) {
    gproj_error error;
    if (number < 1 || number > e->last || !e->state[number]) return;
    if (gproj_state_restore(e->form, e->state[number], e->size[number], &error) == GPROJ_OK) e->now = number;
}

/* Where the mouse is: it goes up by a tenth of an edge each time. */
static void follow_mouse(editor *e, double up) {
    static double to[3];
    if (up == 0) memcpy(to, e->mesh->position + 3 * HANDLE, sizeof to);
    to[2] += up;
    if (e->drag) gproj_drag_move(e->drag, to);
}

/* Events are words, and known by their first letters. */
static void handle(editor *e, const char *event) {
    int32_t vertex = HANDLE;
    gproj_handles handles = {1, NULL, &vertex, NULL, NULL};
    switch (event[0]) {
    case 's': gproj_solve_begin(e->form, 30, NULL, NULL); break;
    case 'g': /* grab: stops a solve that is on */
        e->drag = gproj_drag_begin(e->form, &handles, NULL, NULL);
        follow_mouse(e, 0);
        break;
    case 'm': follow_mouse(e, 0.1); break;
    case 'd': /* drop: the verdict of the release is not looked at here */
        gproj_drag_end(e->drag), e->drag = NULL;
        remember(e);
        break;
    case 'e': gproj_drag_cancel(e->drag), e->drag = NULL; break;
    case 'u': go_to(e, e->now - 1); break;
    case 'r': go_to(e, e->now + 1); break;
    }
}

static void roof(int32_t i, int32_t j, double p[3]) {
    double x = (double)i / SIDE - 0.5, y = (double)j / SIDE - 0.5;
    p[0] = SIDE * x, p[1] = SIDE * y, p[2] = SIDE * (0.2 * cos(3 * x + y) * cos(2 * y) + 0.1 * x * y);
}

int main(void) {
    static const char *const script[] = {"solve", "wait", "grab", "move",   "move", "move", "drop",
                                         "grab",  "move", "move", "escape", "undo", "redo", NULL};
    gproj_host host = gproj_default_host(); /* with a clock, for the frames */
    editor e = {NULL, NULL, NULL, {NULL}, {0}, 0, 0};
    int32_t i;
    const char *const *next = script;
    e.mesh = make_grid(SIDE, SIDE, roof, NULL);
    e.form = gproj_form_create(e.mesh, &host);
    if (!e.mesh) return puts(gproj_code_string(GPROJ_ERROR_MEMORY)), 1;
    gproj_mesh_save(e.mesh, "editor_start.obj", NULL);
    gproj_add_planarity(e.form, 1);
    gproj_add_fixed_corners(e.form, 1);
    gproj_add_fairness(e.form, 0.05);
    while (*next) { /* one frame */
        bool busy = gproj_solve_is_on(e.form);
        if (busy) gproj_solve_advance(e.form, frame_seconds); /* as many iterations as fit, at least one */
        if (busy && !gproj_solve_is_on(e.form)) remember(&e);
        if (busy && **next == 'w') continue; /* the script waits for the solver; a user would not */
        handle(&e, *next);
        printf("%-7s handle at %.3f, planarity %s\n", *next++, e.mesh->position[3 * HANDLE + 2],
               gproj_measure(e.mesh, NULL, NULL).planarity_max < 1e-12 ? "exact" : "not exact");
        /* here the editor draws the mesh */
    }
    gproj_mesh_save(e.mesh, "editor_loop.obj", NULL);
    for (i = 1; i < STATES; ++i) free(e.state[i]);
    gproj_form_destroy(e.form);
    gproj_mesh_destroy(e.mesh);
    return 0;
}
