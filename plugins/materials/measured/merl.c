/* SPDX-License-Identifier: Apache-2.0 */
#include "merl.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 32, PHIS = 64, LEAST_STEPS = 180, SHARES = 10, HEAD = 4, ROW_HEAD = 4 };
static const double pi = 3.14159265358979323846;

typedef struct Merl {
    int n[3]; /* theta_h, theta_d, phi_d */
    const float* rgb;
} Merl;

static void refuse(const RestageTableFile1* file, const char* sentence) { file->error(file->ctx, 0, sentence); }

/* The three counts, or 0 after an error. */
static int read_head(const RestageTableFile1* file, int n[3]) {
    char head[13] = {0}, text[512];
    double entries;
    int i;
    if (file->length < 12) {
        refuse(file, "is too short for a MERL file (.binary)");
        return 0;
    }
    if (!file->bytes(file->ctx, 0, 12, head)) return 0;
    if (strncmp(head, "tensor_file", 11) == 0) {
        refuse(file, "is of RGL's material database (.bsdf), which is another format; MERL's .binary is read");
        return 0;
    }
    for (i = 0; i < 12 && (head[i] == '\t' || head[i] == '\n' || head[i] == '\r' || (head[i] >= 32 && head[i] < 127));
         ++i) {
    }
    if (i == 12) {
        refuse(file, "is text, not a MERL file (.binary)");
        return 0;
    }
    memcpy(n, head, 12); /* little-endian, like this machine */
    entries = (double)n[0] * n[1] * n[2];
    if (n[0] < 1 || n[1] < 1 || n[2] < 1 || n[0] > 4096 || n[1] > 4096 || n[2] > 4096) {
        snprintf(text, sizeof text, "says it has %d x %d x %d entries: not a MERL file (.binary)", n[0], n[1], n[2]);
        refuse(file, text);
        return 0;
    }
    if ((double)file->length != 12 + 24 * entries) {
        snprintf(text, sizeof text, "has %.0f bytes where %d x %d x %d entries take %.0f: %s", (double)file->length,
                 n[0], n[1], n[2], 12 + 24 * entries,
                 (double)file->length < 12 + 24 * entries ? "it is cut short; copy it again"
                                                          : "it is not a MERL file (.binary)");
        refuse(file, text);
        return 0;
    }
    return 1;
}

/* The entries as floats; 0 after an error. Counts what was not measured. */
static int read_entries(const RestageTableFile1* file, const int n[3], float* out) {
    static const double scale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500}; /* the database's own reader's */
    const size_t slab = (size_t)n[1] * (size_t)n[2];
    double missing = 0, broken = 0;
    const double total = 3.0 * (double)slab * n[0];
    double* values = (double*)malloc(slab * sizeof(double));
    char text[160];
    int c, h;
    size_t i;
    if (!values) {
        refuse(file, "cannot be read: there is not enough memory");
        return 0;
    }
    for (c = 0; c < 3; ++c)
        for (h = 0; h < n[0]; ++h) {
            const size_t at = ((size_t)c * (size_t)n[0] + (size_t)h) * slab;
            if (!file->bytes(file->ctx, 12 + 8 * (uint64_t)at, 8 * (uint64_t)slab, values)) {
                free(values);
                return 0;
            }
            for (i = 0; i < slab; ++i) {
                const double v = values[i] * scale[c];
                const int finite = v <= 1e30 && v >= -1e30; /* NaN is neither */
                if (!finite) broken += 1;
                if (finite && v < 0) missing += 1;
                out[3 * ((size_t)h * slab + i) + (size_t)c] = finite && v >= 0 ? (float)v : -1;
            }
        }
    free(values);
    const int per_mille = (int)(1000 * missing / total + 0.5); /* in two parts: %g would obey the host's locale */
    snprintf(text, sizeof text, "%d x %d x %d entries, %d.%d %% of them not measured", n[0], n[1], n[2], per_mille / 10,
             per_mille % 10);
    file->note(file->ctx, text);
    if (broken > 0) {
        snprintf(text, sizeof text, "%.0f values are not finite (taken as not measured)", broken);
        file->note(file->ctx, text);
    }
    return 1;
}

/* BRDF of a half vector and a difference angle, as measured.glsl interpolates it. */
static void look_up(const Merl* m, double theta_h, double theta_d, double phi_d, double rgb[3]) {
    const double x[3] = {m->n[0] * sqrt(theta_h * 2 / pi) - 0.5, m->n[1] * (theta_d * 2 / pi) - 0.5,
                         m->n[2] * (phi_d / pi) - 0.5};
    double f[3], weight[3] = {0, 0, 0};
    int base[3], i, k, c;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (i = 0; i < 3; ++i) {
        base[i] = (int)floor(x[i]);
        f[i] = x[i] - base[i];
    }
    for (k = 0; k < 8; ++k) {
        double w = 1;
        int at[3];
        const float* entry;
        for (i = 0; i < 3; ++i) {
            const int bit = k >> i & 1;
            w *= bit ? f[i] : 1 - f[i];
            at[i] = base[i] + bit;
            at[i] = i == 2 ? (at[i] + m->n[2]) % m->n[2] : at[i] < 0 ? 0 : at[i] >= m->n[i] ? m->n[i] - 1 : at[i];
        }
        entry = m->rgb + 3 * (((size_t)at[0] * (size_t)m->n[1] + (size_t)at[1]) * (size_t)m->n[2] + (size_t)at[2]);
        for (c = 0; c < 3; ++c)
            if (entry[c] >= 0) {
                rgb[c] += w * entry[c];
                weight[c] += w;
            }
    }
    for (c = 0; c < 3; ++c)
        rgb[c] = weight[c] > 0 ? rgb[c] / weight[c] : 0;
}

typedef struct Cell { /* of directions wi about one wo */
    double rgb[3], lum;  /* f |cos wi| */
    double cos_i, cos_d; /* of wi, and of wo to the half vector */
    double solid;        /* its angle [sr] */
    double density;      /* of half vectors there */
} Cell;

/* wo has azimuth 0, h has phi, wi is wo mirrored at h. 0 = below the surface. */
static int find_cell(const Merl* m, double theta_o, double theta_h, double phi, Cell* cell) {
    const double so = sin(theta_o), co = cos(theta_o), sh = sin(theta_h), ch = cos(theta_h);
    const double oh = so * sh * cos(phi) + co * ch;
    const double x = 2 * oh * sh * cos(phi) - so, y = 2 * oh * sh * sin(phi), z = 2 * oh * ch - co;
    double phi_d;
    int i;
    if (oh <= 0 || z <= 0) return 0;
    phi_d = atan2(y * cos(phi) - x * sin(phi), (x * cos(phi) + y * sin(phi)) * ch - z * sh);
    look_up(m, theta_h, acos(oh < 1 ? oh : 1), phi_d < 0 ? phi_d + pi : phi_d, cell->rgb);
    for (i = 0; i < 3; ++i)
        cell->rgb[i] *= z;
    cell->lum = 0.2126 * cell->rgb[0] + 0.7152 * cell->rgb[1] + 0.0722 * cell->rgb[2];
    cell->cos_i = z;
    cell->cos_d = oh;
    return 1;
}

static double theta_of(double s) { return pi / 2 * s * s; } /* s: the place in the table, 0 to 1 */
static double versine(double s) { return 2 * pow(sin(theta_of(s) / 2), 2); }

/* Density of half vectors at the edges of the bins, linear in the versine between them, for one wo: f |cos wi| over
 * wi, averaged around; and its integrals. 0 = nothing is reflected. */
static int make_marginal(const Merl* m, double theta_o, double* nodes, float* row) {
    const int bins = m->n[0];
    float *sums = row + ROW_HEAD, *density = sums + bins;
    double sum = 0, up_to = 0;
    int k, p;
    for (k = 0; k <= bins; ++k) {
        nodes[k] = 0;
        for (p = 0; p < PHIS; ++p) {
            Cell cell;
            if (find_cell(m, theta_o, theta_of((double)k / bins), 2 * pi * (p + 0.5) / PHIS, &cell))
                nodes[k] += cell.lum * 4 * cell.cos_d;
        }
        if (k > 0) sum += pi * (nodes[k] + nodes[k - 1]) * (versine((double)k / bins) - versine((k - 1.0) / bins));
    }
    if (!(sum > 0)) return 0;
    for (k = 0; k <= bins; ++k) {
        density[k] = (float)(nodes[k] / sum);
        nodes[k] = density[k];
        if (k == 0) continue;
        up_to += pi * (nodes[k] + nodes[k - 1]) * (versine((double)k / bins) - versine((k - 1.0) / bins));
        sums[k - 1] = k == bins ? 1 : (float)up_to;
    }
    return 1;
}

/* For one wo: albedo, marginal of theta_h, and the fraction of half-vector samples that minimizes the variance. `cells`
 * has room for bins * steps * PHIS. */
static void make_row(const Merl* m, double theta_o, int steps, Cell* cells, double* nodes, float* row) {
    const int bins = m->n[0], any = make_marginal(m, theta_o, nodes, row);
    double albedo[3] = {0, 0, 0}, best = 0;
    int count = 0, k, c, p, i, share;
    for (k = 0; k < bins * steps; ++k) {
        const double all = bins * steps, bin = k / steps, low = versine(bin / bins), high = versine((bin + 1) / bins);
        const double t = (versine((k + 0.5) / all) - low) / (high - low);
        for (p = 0; p < PHIS; ++p) {
            Cell* cell = &cells[count];
            if (!find_cell(m, theta_o, theta_of((k + 0.5) / all), 2 * pi * (p + 0.5) / PHIS, cell)) continue;
            /* solid angle of wi by that of h: Walter et al. 2007, Eq. 14 */
            cell->solid = 4 * cell->cos_d * 2 * pi / PHIS * (versine((k + 1) / all) - versine(k / all));
            cell->density = any ? (1 - t) * nodes[k / steps] + t * nodes[k / steps + 1] : 0;
            for (i = 0; i < 3; ++i)
                albedo[i] += cell->rgb[i] * cell->solid;
            ++count;
        }
    }
    for (i = 0; i < 3; ++i)
        row[i] = (float)(albedo[i] < 1 ? albedo[i] : 1);
    row[3] = 0;
    for (share = 0; any && share < SHARES; ++share) { /* the second moment of f |cos| / pdf */
        const double s = (double)share / SHARES;
        double second = 0;
        for (c = 0; c < count; ++c) {
            const double pdf = s * cells[c].density / (4 * cells[c].cos_d) + (1 - s) * cells[c].cos_i / pi;
            second += cells[c].lum * cells[c].lum / pdf * cells[c].solid;
        }
        if (share == 0 || second < best) {
            best = second;
            row[3] = (float)s;
        }
    }
}

int merl_read(const char* param_id, const RestageTableFile1* file) {
    int n[3], row, steps;
    size_t entries, row_words, rows_words;
    uint32_t* words;
    float* floats;
    double* nodes;
    Cell* cells;
    Merl m;
    (void)param_id;
    if (!read_head(file, n)) return 0;
    entries = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    row_words = ROW_HEAD + 2 * (size_t)n[0] + 1;
    rows_words = ROWS * row_words;
    words = file->append(file->ctx, HEAD + rows_words + 3 * entries);
    if (!words) return 0;
    for (row = 0; row < 3; ++row)
        words[row] = (uint32_t)n[row];
    words[3] = ROWS;
    steps = (LEAST_STEPS + n[0] - 1) / n[0];
    floats = (float*)malloc((rows_words > 3 * entries ? rows_words : 3 * entries) * sizeof(float));
    nodes = (double*)malloc(((size_t)n[0] + 1) * sizeof(double));
    cells = (Cell*)malloc((size_t)n[0] * (size_t)steps * PHIS * sizeof(Cell));
    if (!floats || !nodes || !cells) refuse(file, "cannot be read: there is not enough memory");
    if (floats && nodes && cells && read_entries(file, n, floats)) {
        float* rows = (float*)calloc(rows_words, sizeof(float));
        memcpy(words + HEAD + rows_words, floats, 3 * entries * sizeof(float));
        memcpy(m.n, n, sizeof m.n);
        m.rgb = floats;
        for (row = 0; rows && row < ROWS; ++row)
            make_row(&m, pi / 2 * (row + 0.5) / ROWS, steps, cells, nodes, rows + (size_t)row * row_words);
        if (rows) memcpy(words + HEAD, rows, rows_words * sizeof(float));
        words = rows ? words : NULL;
        free(rows);
    } else {
        words = NULL;
    }
    free(cells);
    free(nodes);
    free(floats);
    if (!words) refuse(file, "cannot be read: there is not enough memory"); /* only if no error was reported before */
    return words != NULL;
}
