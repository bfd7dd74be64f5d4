# SPDX-License-Identifier: Apache-2.0
"""The closed-form materials computed independently, in double precision, from the papers and not from our GLSL.

Every function takes wo, wi (n, 3) and arrays of parameters (n,) or (n, 3) and returns f(wo, wi) |cos wi|, (n, 3).
Formulas that the GLSL rearranges for single precision are here as printed."""
import math

import numpy as np

erf = np.vectorize(math.erf)


def dot(a, b):
    return (a * b).sum(-1)


def normalize(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def up(v):
    return v * np.where(v[:, 2:] < 0, (1.0, 1.0, -1.0), 1.0)


# --- Fresnel ----------------------------------------------------------------------------------------------------------

def fresnel(cos_i, eta):
    """Unpolarized reflectance; eta = index behind / before, complex for conductors. Born and Wolf, 1.5.2, Eqs. 21."""
    sin2_t = (1 - cos_i**2) / (eta * eta + 0j)
    cos_t = np.sqrt(1 - sin2_t)
    perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
    return 0.5 * (abs(perpendicular)**2 + abs(parallel)**2)


def schlick(r0, cos_i):
    return r0 + (1 - r0) * (1 - cos_i[:, None])**5  # Schlick 1994, Eq. 15


# --- microfacets ------------------------------------------------------------------------------------------------------

def distribution(h, ax, ay, beckmann):
    """Density of normals by slopes: Heitz 2014, Eqs. 78 to 85."""
    tan_x, tan_y, cos = h[:, 0] / h[:, 2], h[:, 1] / h[:, 2], h[:, 2]
    q = (tan_x / ax)**2 + (tan_y / ay)**2
    p22 = np.exp(-q) / (np.pi * ax * ay) if beckmann else 1 / (np.pi * ax * ay * (1 + q)**2)
    return p22 / cos**4


def smith_lambda(w, ax, ay, beckmann):
    """Walter et al. 2007, Eq. 26 before its fit, and 34; anisotropic: Heitz 2014, Eq. 80."""
    tan_alpha = np.hypot(ax * w[:, 0], ay * w[:, 1]) / np.abs(w[:, 2])
    if not beckmann:
        return (-1 + np.sqrt(1 + tan_alpha**2)) / 2
    a = 1 / np.maximum(tan_alpha, 1e-300)
    return np.where(a > 25, 0.0, (erf(a) - 1) / 2 + np.exp(-np.minimum(a, 25)**2) / (2 * a * math.sqrt(math.pi)))


def shadowing(wo, wi, ax, ay, beckmann, correlated=True):
    """Heitz 2014, Eq. 99; not correlated: G1 G1, Eq. 98."""
    o, i = smith_lambda(wo, ax, ay, beckmann), smith_lambda(wi, ax, ay, beckmann)
    return 1 / (1 + o + i) if correlated else 1 / ((1 + o) * (1 + i))


# --- materials --------------------------------------------------------------------------------------------------------

def lambert(wo, wi, reflectance):
    return np.where(wo[:, 2] * wi[:, 2] > 0, np.abs(wi[:, 2]) / np.pi, 0)[:, None] * reflectance


def oren_nayar(wo, wi, reflectance, sigma_degrees):
    """Oren and Nayar 1994, Eq. 30, with its angles."""
    o, i = up(wo), up(wi)
    s2 = np.radians(sigma_degrees)**2
    theta_o, theta_i = np.arccos(np.clip(o[:, 2], 0, 1)), np.arccos(np.clip(i[:, 2], 0, 1))
    phi = np.arctan2(o[:, 1], o[:, 0]) - np.arctan2(i[:, 1], i[:, 0])
    alpha, beta = np.maximum(theta_o, theta_i), np.minimum(theta_o, theta_i)
    a, b = 1 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09)
    factor = a + b * np.maximum(0, np.cos(phi)) * np.sin(alpha) * np.tan(beta)
    return lambert(wo, wi, reflectance) * factor[:, None]


def conductor(wo, wi, eta, k, ax, ay, beckmann, correlated=True):
    """Torrance and Sparrow 1967; Walter et al. 2007, Eq. 20."""
    same = wo[:, 2] * wi[:, 2] > 0
    o, i = up(wo), up(wi)
    h = normalize(o + i)
    f = fresnel(dot(o, h)[:, None], eta + 1j * k)
    g = shadowing(o, i, ax, ay, beckmann, correlated) * distribution(h, ax, ay, beckmann) / (4 * o[:, 2] * i[:, 2])
    return np.where(same, g * i[:, 2], 0)[:, None] * f


def dielectric(wo, wi, eta, ax, ay, beckmann, correlated=True):
    """Walter et al. 2007, Eqs. 16 and 19 to 21, light coming from wi: no tint; eta = index below / above, n = +z."""
    flip = np.where(wo[:, 2:] < 0, -1.0, 1.0)
    index = np.where(wo[:, 2] < 0, 1 / eta, eta)  # behind wo's side / on it
    o, i = wo * np.concatenate([np.ones_like(flip), np.ones_like(flip), flip], 1), wi * np.concatenate(
        [np.ones_like(flip), np.ones_like(flip), flip], 1)
    reflects = i[:, 2] > 0
    n_i = np.where(reflects, 1.0, index)  # index on wi's side; on wo's side it is 1
    h = normalize(np.where(reflects[:, None], o + i, -(o + n_i[:, None] * i)))
    h = h * np.where(h[:, 2:] < 0, -1.0, 1.0)
    oh, ih = dot(o, h), dot(i, h)
    f = fresnel(np.clip(np.abs(oh), 0, 1), index)
    d, g = distribution(h, ax, ay, beckmann), shadowing(o, i, ax, ay, beckmann, correlated)
    cos_o, cos_i = np.abs(o[:, 2]), np.abs(i[:, 2])
    reflection = f * g * d / (4 * cos_o * cos_i)
    with np.errstate(divide="ignore", invalid="ignore"):
        transmission = np.abs(ih * oh) / (cos_i * cos_o) * (1 - f) * g * d / (n_i * ih + oh)**2
    possible = (oh > 0) & ((ih > 0) == reflects)
    value = np.where(possible, np.where(reflects, reflection, transmission) * cos_i, 0)
    return np.repeat(value[:, None], 3, 1)


def substrate(wo, wi, kd, ks, ax, ay):
    """Ashikhmin and Shirley 2000, Eqs. 4 and 5, as in pbrt-v3 (GGX for the distribution; Eqs. 8.20, 8.21)."""
    same = wo[:, 2] * wi[:, 2] > 0
    o, i = up(wo), up(wi)
    h = normalize(o + i)
    fade = (1 - (1 - o[:, 2] / 2)**5) * (1 - (1 - i[:, 2] / 2)**5)
    base = 28 * kd / (23 * np.pi) * (1 - ks) * fade[:, None]
    coat = distribution(h, ax, ay, False) / (4 * dot(i, h) * np.maximum(o[:, 2], i[:, 2]))
    return np.where(same, i[:, 2], 0)[:, None] * (base + coat[:, None] * schlick(ks, dot(i, h)))


def plastic(wo, wi, kd, ks, alpha):
    """pbrt-v3's: kd / pi + ks times GGX with FresnelDielectric(1.5, 1), light arriving inside when seen from above."""
    o, i = up(wo), up(wi)
    h = normalize(o + i)
    index = np.where(wo[:, 2] > 0, 1 / 1.5, 1.5)
    gloss = (distribution(h, alpha, alpha, False) * shadowing(o, i, alpha, alpha, False) * fresnel(dot(i, h), index) /
             (4 * o[:, 2] * i[:, 2]))
    same = wo[:, 2] * wi[:, 2] > 0
    return np.where(same, i[:, 2], 0)[:, None] * (kd / np.pi + ks * gloss[:, None])


def diffuse_transmission(wo, wi, reflectance, transmittance):
    same = (wo[:, 2] * wi[:, 2] > 0)[:, None]
    return np.abs(wi[:, 2:]) / np.pi * np.where(same, reflectance, transmittance)


def translucent(wo, wi, kd, ks, reflect, transmit, alpha):
    """pbrt-v3's: Lambert and a rough interface of index 1.5, on both sides, scaled and added."""
    same = (wo[:, 2] * wi[:, 2] > 0)[:, None]
    glossy = dielectric(wo, wi, np.full(len(wo), 1.5), alpha, alpha, False)
    return np.where(same, reflect, transmit) * (kd * np.abs(wi[:, 2:]) / np.pi + ks * glossy)


def v3_alpha(roughness):
    """pbrt-v3, TrowbridgeReitzDistribution::RoughnessToAlpha."""
    x = np.log(np.maximum(roughness, 1e-3))
    return 1.62142 + 0.819955 * x + 0.1734 * x**2 + 0.0171201 * x**3 + 0.000640711 * x**4


def hair(wo, wi, color, eta, beta_m, beta_n, alpha_degrees):
    """Chiang et al. 2016, in angles: theta, the inclination to the normal plane, and psi, from the normal about the fibre.
    From within the fibre (wo.z < 0) nothing is scattered."""
    theta_o, theta_i = np.arcsin(np.clip(wo[:, 0], -1, 1)), np.arcsin(np.clip(wi[:, 0], -1, 1))
    psi_o, psi_i = np.arctan2(wo[:, 1], wo[:, 2]), np.arctan2(wi[:, 1], wi[:, 2])
    # Eqs. 7 and 8, and the s of a logistic distribution
    v = (0.726 * beta_m + 0.812 * beta_m**2 + 3.7 * beta_m**20)**2
    variances = [v, v / 4, 4 * v, 4 * v]
    s = math.sqrt(np.pi / 8) * (0.265 * beta_n + 1.194 * beta_n**2 + 5.372 * beta_n**22)
    # Eq. 9, then the way through the cylinder of radius 1
    b = beta_n
    sigma = (np.log(color) / (5.969 - 0.215 * b + 2.532 * b**2 - 10.73 * b**3 + 5.574 * b**4 + 0.245 * b**5)[:, None])**2
    theta_t = np.arcsin(np.sin(theta_o) / eta)
    eta_p = np.sqrt(eta**2 - np.sin(theta_o)**2) / np.cos(theta_o)
    gamma_t = np.arcsin(np.sin(psi_o) / eta_p)
    t = np.exp(-sigma * (2 * np.cos(gamma_t) / np.cos(theta_t))[:, None])
    f = fresnel(np.cos(theta_o) * np.cos(psi_o), eta)[:, None]
    attenuations = [f + 0 * t, (1 - f)**2 * t, (1 - f)**2 * t**2 * f, (1 - f)**2 * t**3 * f**2 / (1 - f * t)]
    alpha = np.radians(alpha_degrees)
    result = 0
    for p, turn in enumerate((-2, 1, 4, 0)):
        inclined = theta_o + turn * alpha
        a = np.cos(theta_i) * np.abs(np.cos(inclined)) / variances[p]
        # d'Eon et al. 2011, Eq. 7
        m = np.exp(-np.sin(theta_i) * np.sin(inclined) / variances[p]) * np.i0(a) / (2 * variances[p] * np.sinh(1 / variances[p]))
        if p < 3:
            x = psi_i - psi_o - (2 * p * gamma_t - 2 * psi_o + p * np.pi)
            x = (x + np.pi) % (2 * np.pi) - np.pi
            n = np.exp(-np.abs(x) / s) / (s * (1 + np.exp(-np.abs(x) / s))**2) / np.tanh(np.pi / (2 * s))
        else:
            n = 1 / (2 * np.pi)
        result = result + attenuations[p] * (m * n)[:, None]
    return np.where((wo[:, 2] > 0)[:, None], result, 0)
