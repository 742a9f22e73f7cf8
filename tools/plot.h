/* plot.h - curves over the iterations on a logarithmic scale, as an SVG picture, for the examples.

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
    const char *name, *colour; /* plain text without < and & */
    int count;
    const double *value;
} gprojx_curve;

enum {
    GPROJX_PLOT_LEFT = 70,
    GPROJX_PLOT_TOP = 70,
    GPROJX_PLOT_WIDE = 640,
    GPROJX_PLOT_HIGH = 400
};

/* Powers of ten at the ends of the scale: they enclose all values. */
static void gprojx_plot_scale(int count, const gprojx_curve *curve, double *low, double *high, int *last) {
    int k, i;
    *low = 0, *high = -16, *last = 1;
    for (k = 0; k < count; ++k)
        for (i = 0; i < curve[k].count; ++i) {
            double power = log10(fmax(curve[k].value[i], 1e-16));
            *low = fmin(*low, floor(power)), *high = fmax(*high, ceil(power));
            if (i > *last) *last = i;
        }
}

/* Lines of the grid with their powers of ten and iterations. */
static void gprojx_plot_grid(FILE *file, int low, int high, int last) {
    int i, step = high - low > 8 ? 2 : 1;
    for (i = high; i >= low; i -= step) {
        int y = GPROJX_PLOT_TOP + (high - i) * GPROJX_PLOT_HIGH / (high - low);
        fprintf(file, "<path stroke=\"#ddd\" d=\"M%d %dh%d\"/>\n", GPROJX_PLOT_LEFT, y, GPROJX_PLOT_WIDE);
        fprintf(file,
                "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">10<tspan dy=\"-5\" font-size=\"10\">%d</tspan></text>\n",
                GPROJX_PLOT_LEFT - 10, y + 5, i);
    }
    for (i = 0, step = last > 20 ? last / 10 : 1; i <= last; i += step) {
        int x = GPROJX_PLOT_LEFT + i * GPROJX_PLOT_WIDE / last;
        fprintf(file, "<path stroke=\"#eee\" d=\"M%d %dv%d\"/>\n", x, GPROJX_PLOT_TOP, GPROJX_PLOT_HIGH);
        fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%d</text>\n", x,
                GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 20, i);
    }
}

static void gprojx_plot_curve(FILE *file, const gprojx_curve *curve, double low, double high, int last) {
    int i, dots;
    for (dots = 0; dots < 2; ++dots) {
        if (!dots) fprintf(file, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"2\" d=\"", curve->colour);
        for (i = 0; i < curve->count; ++i) {
            double power = log10(fmax(curve->value[i], 1e-16));
            int x = GPROJX_PLOT_LEFT + i * GPROJX_PLOT_WIDE / last;
            int y = GPROJX_PLOT_TOP + (int)((high - power) / (high - low) * GPROJX_PLOT_HIGH + 0.5);
            if (dots)
                fprintf(file, "<circle fill=\"%s\" r=\"3\" cx=\"%d\" cy=\"%d\"/>\n", curve->colour, x, y);
            else
                fprintf(file, "%c%d %d", i ? 'L' : 'M', x, y);
        }
        if (!dots) fputs("\"/>\n", file);
    }
}

/* Writes the plot. Returns GPROJ_OK or GPROJ_ERROR_FILE. */
static gproj_code gprojx_plot(FILE *file, const char *title, int count, const gprojx_curve *curve) {
    double low, high;
    int last, k, width = GPROJX_PLOT_LEFT + GPROJX_PLOT_WIDE + 40;
    int height = GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 70 + 24 * count;
    gprojx_plot_scale(count, curve, &low, &high, &last);
    fprintf(
        file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" font-size=\"14\""
        " font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" fill=\"#222\">\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
        width, height, width, height);
    fprintf(file, "<text x=\"40\" y=\"40\" font-size=\"20\" font-weight=\"bold\">%s</text>\n", title);
    gprojx_plot_grid(file, (int)low, (int)high, last);
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">iterations</text>\n",
            GPROJX_PLOT_LEFT + GPROJX_PLOT_WIDE / 2, GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 42);
    for (k = 0; k < count; ++k) {
        int y = GPROJX_PLOT_TOP + GPROJX_PLOT_HIGH + 64 + 24 * k;
        gprojx_plot_curve(file, &curve[k], low, high, last);
        fprintf(file, "<path stroke=\"%s\" stroke-width=\"3\" d=\"M%d %dh30\"/>\n", curve[k].colour, GPROJX_PLOT_LEFT,
                y);
        fprintf(file, "<text x=\"%d\" y=\"%d\">%s</text>\n", GPROJX_PLOT_LEFT + 42, y + 5, curve[k].name);
    }
    fputs("</svg>\n", file);
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

#endif
