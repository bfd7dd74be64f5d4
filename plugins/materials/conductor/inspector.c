/* SPDX-License-Identifier: Apache-2.0 */
/* The inspector of a metal: a choice of metals, and the reflectance over the angle of incidence. */
#include "inspector.h"

#include <math.h>
#include <stddef.h>

/* Optical constants for linear sRGB primaries: eta and k whose normal reflectance is that
 * Johnson and Christy 1972 and 1974 (Rakic 1995 for aluminium), from refractiveindex.info (public domain, CC0). */
typedef struct Metal {
    const char* name;
    float eta[3], k[3];
} Metal;
static const Metal metals[] = {
    {"Aluminium", {1.4809f, 0.9821f, 0.5980f}, {7.6008f, 6.5389f, 5.3147f}},
    {"Chromium", {3.2509f, 3.1070f, 2.2792f}, {3.2868f, 3.3354f, 3.1141f}},
    {"Copper", {0.1739f, 1.0434f, 1.2900f}, {2.9640f, 2.6244f, 2.3574f}},
    {"Gold", {0.0584f, 0.5006f, 1.4587f}, {15.2494f, 2.2619f, 1.7717f}},
    {"Iron", {2.9242f, 2.9170f, 2.5451f}, {3.0774f, 2.9372f, 2.7497f}},
    {"Nickel", {2.0222f, 1.9011f, 1.7243f}, {4.1916f, 3.5686f, 2.8930f}},
    {"Silver", {0.0555f, 0.0547f, 0.0430f}, {4.4437f, 3.5375f, 2.5793f}},
    {"Titanium", {2.7369f, 2.5072f, 2.2362f}, {3.8392f, 3.3972f, 3.0134f}},
};
enum { metal_count = sizeof metals / sizeof metals[0], a_color = metal_count, angles = 64 };

static int same(const float* a, const float* b) {
    int i;
    for (i = 0; i < 3; ++i)
        if (fabsf(a[i] - b[i]) > 2e-3f) return 0;
    return 1;
}

/* Of a conductor eta + ik in air, unpolarized: Born and Wolf; the real form is Lagarde's, 2013. */
static float reflectance(float cos_i, float eta, float k) {
    const float c2 = cos_i * cos_i, s2 = 1 - c2, t0 = eta * eta - k * k - s2;
    const float a2b2 = sqrtf(t0 * t0 + 4 * eta * eta * k * k);
    const float t1 = a2b2 + c2, t2 = 2 * cos_i * sqrtf(fmaxf(0, (a2b2 + t0) / 2));
    const float t3 = c2 * a2b2 + s2 * s2, t4 = t2 * s2;
    const float rs = (t1 - t2) / fmaxf(t1 + t2, 1e-20f);
    return (rs + rs * (t3 - t4) / fmaxf(t3 + t4, 1e-20f)) / 2;
}

static void draw(const RestageUi1* ui, void* ctx) {
    const char* names[metal_count + 1];
    float curves[3 * angles];
    RestageValue eta = {.size = sizeof eta}, k = {.size = sizeof k};
    RestageValue tint = {.size = sizeof tint}, use = {.size = sizeof use};
    int i, c, current = -1, chosen;
    if (!ui->get(ctx, "eta", &eta) || !ui->get(ctx, "k", &k) || !ui->get(ctx, "reflectance", &tint) ||
        !ui->get(ctx, "use_reflectance", &use))
        return;
    for (i = 0; i < metal_count; ++i) {
        names[i] = metals[i].name;
        if (same(eta.v, metals[i].eta) && same(k.v, metals[i].k)) current = i;
    }
    names[a_color] = "By its colour";
    if (use.i != 0) current = a_color;
    chosen = ui->combo(ctx, "Metal", names, metal_count + 1, current);
    if (chosen == a_color) {
        use.i = 1;
        ui->set(ctx, "Metal by its colour", &use, 1);
    } else if (chosen >= 0) {
        RestageValue values[3];
        values[0] = eta, values[1] = k, values[2] = use;
        values[0].ref = values[1].ref = 0;
        for (c = 0; c < 3; ++c) {
            values[0].v[c] = metals[chosen].eta[c];
            values[1].v[c] = metals[chosen].k[c];
        }
        values[2].i = 0;
        ui->set(ctx, metals[chosen].name, values, 3);
    }
    for (i = 0; i < angles; ++i) {
        const float cos_i = cosf((float)i / (angles - 1) * 1.57079633f);
        for (c = 0; c < 3; ++c) {
            const float r = fminf(fmaxf(tint.v[c], 0), 0.9999f);
            curves[c * angles + i] =
                use.i != 0 ? reflectance(cos_i, 1, 2 * sqrtf(r / (1 - r))) : reflectance(cos_i, eta.v[c], k.v[c]);
        }
    }
    ui->plot(ctx, "Reflectance from normal to grazing incidence [deg]", curves, angles, 3, 0, 90, 0, 1);
    if (use.i != 0) ui->param(ctx, "reflectance");
    ui->hide(ctx, "eta");
    ui->hide(ctx, "k");
    ui->hide(ctx, "reflectance");
    ui->hide(ctx, "use_reflectance");
    if (ui->begin_group(ctx, "Optical constants")) {
        ui->param(ctx, "eta");
        ui->param(ctx, "k");
        if (use.i == 0) ui->param(ctx, "reflectance");
        ui->param(ctx, "use_reflectance");
        ui->end_group(ctx);
    }
}

const RestageInspector1 conductor_inspector = {sizeof(RestageInspector1), "conductor", draw};
