/* plot.h - curves on a logarithmic scale, as an SVG picture, for the examples and for bench.

       gprojx_curve curve[2] = {{"with normals", "#b03020", 8, with}, {"without", "#2060a0", 8, without}};
       if (gprojx_plot(file, "planarity after each iteration", 2, curve) != GPROJ_OK) ...

   Include guidedproj.h before this file. No memory is taken; coordinates are written as integers, so the locale does
   not matter. */
#ifndef GPROJX_PLOT_H
#define GPROJX_PLOT_H

#include <math.h>
#include <stdio.h>

/* value[i] belongs to iteration i = 0..count-1. Values below 1e-16 are drawn there. */
typedef struct gprojx_curve {
    const char *name, *colour; /* plain text without < and &, as titles */
    int count;
    const double *value;
} gprojx_curve;

enum {
    GPROJX_PLOT_LEFT = 70,
    GPROJX_PLOT_TOP = 70,
    GPROJX_PLOT_WIDE = 640,
    GPROJX_PLOT_HIGH = 400
};

/* What is drawn, and the ends of both scales: powers of ten upwards, iterations or powers of ten across. */
typedef struct gprojx_frame {
    int count;
    const gprojx_curve *curve;
    const double *const *at; /* of each curve, where its values belong on a logarithmic scale; NULL: to iterations */
    double low, high, left, right;
} gprojx_frame;

static double gprojx_plot_across(const gprojx_frame *frame, int curve, int i) {
    return frame->at ? log10(frame->at[curve][i]) : i;
}

static int gprojx_plot_x(const gprojx_frame *frame, double across) {
    return GPROJX_PLOT_LEFT + (int)((across - frame->left) * GPROJX_PLOT_WIDE / (frame->right - frame->left));
}

static int gprojx_plot_y(const gprojx_frame *frame, double power) {
    return GPROJX_PLOT_TOP + (int)((frame->high - power) / (frame->high - frame->low) * GPROJX_PLOT_HIGH + 0.5);
}

/* The ends of the scales enclose all values: with whole powers of ten upwards. */
static gprojx_frame gprojx_plot_frame(int count, const gprojx_curve *curve, const double *const *at) {
    gprojx_frame frame = {0, NULL, NULL, 1000, -1000, 0, 1};
    int k, i;
    frame.count = count, frame.curve = curve, frame.at = at;
    if (at) frame.left = 1000, frame.right = -1000;
    for (k = 0; k < count; ++k)
        for (i = 0; i < curve[k].count; ++i) {
            double power = log10(fmax(curve[k].value[i], 1e-16)), across = gprojx_plot_across(&frame, k, i);
            frame.low = fmin(frame.low, floor(power)), frame.high = fmax(frame.high, ceil(power));
            frame.left = fmin(frame.left, across), frame.right = fmax(frame.right, across);
        }
    if (frame.low > frame.high) frame.low = frame.high = frame.left = frame.right = 0; /* nothing to draw */
    if (!(frame.right > frame.left)) frame.left -= 0.5, frame.right = frame.left + 1;
    if (!(frame.high > frame.low)) frame.high = frame.low + 1;
    return frame;
}

/* A line of the grid across the iterations, with its label. */
static void gprojx_plot_upright(FILE *file, const gprojx_frame *frame, double across, double label) {
    int x = gprojx_plot_x(frame, across);
    fprintf(file, "<path stroke=\"#eee\" d=\"M%d %dv%d\"/>\n", x, GPROJX_PLOT_TOP, GPROJX_PLOT_HIGH);
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%.0f</text>\n", x,
            GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 20, label);
}

/* Lines of the grid with their powers of ten and iterations; 1, 2, 5, 10, 20, ... on a logarithmic scale. */
static void gprojx_plot_grid(FILE *file, const gprojx_frame *frame) {
    int low = (int)frame->low, high = (int)frame->high, last = (int)frame->right, i, step = high - low > 8 ? 2 : 1;
    double decade, digit;
    for (i = high; i >= low; i -= step) {
        int y = GPROJX_PLOT_TOP + (high - i) * GPROJX_PLOT_HIGH / (high - low);
        fprintf(file, "<path stroke=\"#ddd\" d=\"M%d %dh%d\"/>\n", GPROJX_PLOT_LEFT, y, GPROJX_PLOT_WIDE);
        fprintf(file,
                "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">10<tspan dy=\"-5\" font-size=\"10\">%d</tspan></text>\n",
                GPROJX_PLOT_LEFT - 10, y + 5, i);
    }
    for (i = 0, step = last > 20 ? last / 10 : 1; !frame->at && i <= last; i += step)
        gprojx_plot_upright(file, frame, i, i);
    for (decade = 1; frame->at && log10(decade) <= frame->right; decade *= 10)
        for (digit = 1; digit < 10; digit += digit == 1 ? 1 : digit == 2 ? 3 : 5)
            if (log10(digit * decade) >= frame->left && log10(digit * decade) <= frame->right)
                gprojx_plot_upright(file, frame, log10(digit * decade), digit * decade);
}

static void gprojx_plot_curve(FILE *file, const gprojx_frame *frame, int k) {
    const gprojx_curve *curve = &frame->curve[k];
    int i, dots;
    for (dots = 0; dots < 2; ++dots) {
        if (!dots) fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"2\" d=\"", curve->colour);
        for (i = 0; i < curve->count; ++i) {
            int x = gprojx_plot_x(frame, gprojx_plot_across(frame, k, i));
            int y = gprojx_plot_y(frame, log10(fmax(curve->value[i], 1e-16)));
            if (dots)
                fprintf(file, "<circle fill=\"%s\" r=\"3\" cx=\"%d\" cy=\"%d\"/>\n", curve->colour, x, y);
            else
                fprintf(file, "%c%d %d", i ? 'L' : 'M', x, y);
        }
        if (!dots) fputs("\"/>\n", file);
    }
}

static gproj_code gprojx_plot_draw(FILE *file, const char *title, const char *below, const gprojx_frame *frame) {
    int k, width = GPROJX_PLOT_LEFT + GPROJX_PLOT_WIDE + 40;
    int height = GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 70 + 24 * frame->count;
    fprintf(
        file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" font-size=\"14\""
        " font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" fill=\"#222\">\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
        width, height, width, height);
    fprintf(file, "<text x=\"40\" y=\"40\" font-size=\"20\" font-weight=\"bold\">%s</text>\n", title);
    gprojx_plot_grid(file, frame);
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", GPROJX_PLOT_LEFT + GPROJX_PLOT_WIDE / 2,
            GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 42, below);
    for (k = 0; k < frame->count; ++k) {
        int y = GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 64 + 24 * k;
        gprojx_plot_curve(file, frame, k);
        fprintf(file, "<path stroke=\"%s\" stroke-width=\"3\" d=\"M%d %dh30\"/>\n", frame->curve[k].colour,
                GPROJX_PLOT_LEFT, y);
        fprintf(file, "<text x=\"%d\" y=\"%d\">%s</text>\n", GPROJX_PLOT_LEFT + 42, y + 5, frame->curve[k].name);
    }
    fputs("</svg>\n", file);
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

/* Writes the plot over the iterations. Returns GPROJ_OK or GPROJ_ERROR_FILE. */
static inline gproj_code gprojx_plot(FILE *file, const char *title, int count, const gprojx_curve *curve) {
    gprojx_frame frame = gprojx_plot_frame(count, curve, NULL);
    return gprojx_plot_draw(file, title, "iterations", &frame);
}

/* The same over positive numbers on a logarithmic scale, which `below` names: curve k has its values at at[k][i], i =
   0..count-1. */
static inline gproj_code gprojx_plot_powers(FILE *file, const char *title, const char *below, int count,
                                            const gprojx_curve *curve, const double *const *at) {
    gprojx_frame frame = gprojx_plot_frame(count, curve, at);
    return gprojx_plot_draw(file, title, below, &frame);
}

#endif
