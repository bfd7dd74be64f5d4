// SPDX-License-Identifier: Apache-2.0
// Wavefront: the start of photons, from lights towards casters of caustics.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/light.glsl"
#include "lib/photons.glsl"
#include "lib/records.glsl"
#include <restage/v1/frame.glsl>

struct Start {
    vec3 origin, direction;
    Spectrum power; // of what left the light there, over the density of having chosen it
    float radiance; // mean of the colours; 0: a lamp that no path can meet
};

float mean_color(Spectrum s) { return dot(s, Spectrum(1)) / dot(Spectrum(1), Spectrum(1)); }

float cone_solid_angle(CasterSphere c, vec3 p) {
    vec3 d = c.center - p;
    float sin2 = sqr(c.radius) / max(dot(d, d), 1e-30);
    return sin2 >= 1.0 ? 4.0 * PI : TWO_PI * sin2 / (1.0 + sqrt(1.0 - sin2));
}
bool meets(CasterSphere c, vec3 p, vec3 direction) { // a ray
    vec3 d = c.center - p;
    float r2 = sqr(c.radius) * 1.00001;
    vec3 off = cross(d, direction);
    return dot(off, off) <= r2 && (dot(d, direction) > 0.0 || dot(d, d) <= r2);
}

// From a point, uniformly into the cones of all casters; a direction in several of them counts once.
void aim(PhotonMap map, vec3 p, vec2 u, out vec3 direction, out float pdf) {
    CasterArray casters = CasterArray(map.casters);
    float all = 0.0, below = 0.0;
    for (uint k = 0u; k < map.caster_count; ++k) all += cone_solid_angle(casters.at[k], p);
    uint chosen = 0u;
    float x = u.x * all, its = all;
    for (uint k = 0u; k < map.caster_count; ++k) {
        float angle = cone_solid_angle(casters.at[k], p);
        if (x >= below) {
            chosen = k;
            its = angle;
            u.x = clamp((x - below) / angle, 0.0, 0.99999994);
        }
        below += angle;
    }
    float up = u.x * its / TWO_PI; // 1 - cos
    float sin_theta = sqrt(max(0.0, up * (2.0 - up))), phi = TWO_PI * u.y;
    vec3 n = casters.at[chosen].center - p;
    float far = length(n);
    Frame f = frame_from_normal(far > 0.0 ? n / far : vec3(0, 0, 1));
    direction = normalize(sin_theta * (cos(phi) * f.t + sin(phi) * f.b) + (1.0 - up) * f.n);
    float found = 0.0;
    for (uint k = 0u; k < map.caster_count; ++k) found += meets(casters.at[k], p, direction) ? 1.0 : 0.0;
    pdf = max(found, 1.0) / all;
}

// Parallel light onto the casters: where it starts, outside of the scene, per area.
vec3 aim_parallel(PhotonMap map, vec3 direction, vec2 u, out float pdf) {
    CasterArray casters = CasterArray(map.casters);
    float all = 0.0, below = 0.0;
    for (uint k = 0u; k < map.caster_count; ++k) all += PI * sqr(casters.at[k].radius);
    uint chosen = 0u;
    float x = u.x * all;
    for (uint k = 0u; k < map.caster_count; ++k) {
        float area = PI * sqr(casters.at[k].radius);
        if (x >= below) {
            chosen = k;
            u.x = clamp((x - below) / area, 0.0, 0.99999994);
        }
        below += area;
    }
    Frame f = frame_from_normal(direction);
    vec2 disk = sample_disk(u) * casters.at[chosen].radius;
    vec3 p = casters.at[chosen].center + disk.x * f.t + disk.y * f.b;
    float found = 0.0;
    for (uint k = 0u; k < map.caster_count; ++k) {
        vec3 off = cross(casters.at[k].center - p, direction);
        found += dot(off, off) <= sqr(casters.at[k].radius) * 1.00001 ? 1.0 : 0.0;
    }
    pdf = max(found, 1.0) / all;
    return p - direction * (dot(p - map.center, direction) + map.scene_radius);
}

Start start_parallel(PhotonMap map, vec3 direction, Spectrum irradiance, vec2 u) {
    float pdf;
    vec3 origin = aim_parallel(map, direction, u, pdf);
    return Start(origin, direction, irradiance / pdf, 0.0);
}

// Radiance from direction wi over its density. One in four is uniform over the sphere: the densities of light sampling leave
// what is darker than the mean to paths (make_environment_map).
Spectrum start_at_environment(EnvironmentData env, uvec2 bits, out vec3 wi, out float mean_radiance) {
    const uint uniform_ones = 1u << 30;
    Spectrum radiance;
    float pdf;
    if (env.mapping == ENV_CONSTANT || bits.x < uniform_ones) {
        wi = sample_sphere(vec2(to_unit(env.mapping == ENV_CONSTANT ? bits.x : bits.x << 2), to_unit(bits.y)));
        radiance = environment_eval(env, wi, pdf);
    } else {
        LightSample e = environment_sample(env, uvec2((bits.x - uniform_ones) / 3u * 4u, bits.y));
        wi = e.wi;
        radiance = e.radiance;
        pdf = e.pdf;
    }
    mean_radiance = mean_color(radiance);
    return radiance / mix(pdf, 0.25 * INV_PI, 0.25);
}

Start start_on_surface(SceneData scene, PhotonMap map, LightData light, uint index, vec2 place, vec2 u) {
    uint kind = light.kind & 255u;
    vec3 q, n;
    vec2 bary;
    float area = light.area;
    float x = place.x, y = place.y;
    if (HAS_QUADRICS && kind == LIGHT_QUADRIC) {
        InstanceData lamp = InstanceArray(scene.instances).at[light.instance];
        QuadricData quadric = quadric_of(lamp);
        vec3 at = quadric_sample_area(quadric, place), normal = quadric_normal(quadric, at);
        bary = quadric_uv(quadric, at);
        n = lamp.normal_to_world * normal;
        area = quadric.area * abs(determinant(mat3(lamp.object_to_world))) * length(n);
        n = normalize((lamp.flags & INSTANCE_FLIP_NORMAL) != 0u ? -n : n);
        q = lamp.object_to_world * vec4(at, 1.0);
    } else {
        if ((light.kind & LIGHT_PAIR) == 0u) {
            if (y > x) {
                x *= 0.5;
                y -= x;
            } else {
                y *= 0.5;
                x -= y;
            }
        }
        q = light.a + x * light.b + y * light.c;
        bary = (light.kind & LIGHT_SWAPPED) != 0u ? vec2(y, x) : vec2(x, y);
        n = normalize(cross(light.b, light.c));
    }
    Spectrum radiance = stored_spectrum(light.value);
    if ((HAS_EMISSION_TEXTURES || HAS_LIGHT_ALPHA) && light.instance != NONE) {
        InstanceData inst = InstanceArray(scene.instances).at[light.instance];
        uint prim = index - inst.light_base;
        radiance = emitted(scene, inst, prim, bary);
        if (HAS_LIGHT_ALPHA && (inst.flags & INSTANCE_HAS_ALPHA) != 0u && (inst.flags & INSTANCE_EMITS_UNSEEN) == 0u)
            radiance *= hit_alpha(scene, inst, prim, bary);
    }
    Start s;
    float pdf;
    aim(map, q, u, s.direction, pdf);
    float c = dot(n, s.direction);
    if ((light.kind & LIGHT_TWO_SIDED) != 0u) c = abs(c);
    s.radiance = mean_color(radiance);
    s.power = c > 0.0 ? radiance * (area * c / pdf) : Spectrum(0);
    s.origin = offset_origin(q, n, scene.ray_epsilon > 0.0 ? scene.ray_epsilon : light_offset(light, q, 0.0), s.direction);
    return s;
}

// Three numbers choose a photon's source and where at the casters it aims. Their unit cube has cells, which are chosen by
// how many photons from them are seen (PhotonPilot).
Start start_photon(SceneData scene, PhotonMap map, uint seed, uint index, out uint cell) {
    uvec2 pick = sample_bits(seed, index, PAIR_FILTER), place = sample_bits(seed, index, pair_light(0u));
    vec2 u = sample_pair(seed, index, PAIR_LENS);
    uint side = map.start_side, rows = map.start_rows, cells = rows * side * side;
    CdfDraw start = cdf_draw(map.starts, cells, pick.x);
    cell = start.index;
    float share = float(start.end - start.start) * (float(cells) / 4294967296.0);
    u = min((vec2(cell % side, cell / side % side) + u) / float(side), vec2(0.99999994));
    uint row = 0xffffffffu / rows + 1u; // 0 if there is one
    CdfDraw draw = cdf_draw(map.source_cdf, map.source_count, cell / (side * side) * row + pick.y / rows);
    PhotonSource source = PhotonSourceArray(map.sources).at[draw.index];
    LightData light = LightArray(scene.lights).at[source.light];
    uint kind = light.kind & 255u;
    Start s = Start(vec3(0), vec3(0, 0, 1), Spectrum(0), 0.0);
    if (HAS_ENVIRONMENT && kind == LIGHT_ENVIRONMENT) {
        vec3 wi;
        float radiance;
        Spectrum irradiance = start_at_environment(scene.environment, place, wi, radiance);
        s = start_parallel(map, -wi, irradiance, u);
        s.radiance = radiance;
    } else if (HAS_LAMPS && kind >= LIGHT_LAMP && lamp_is_parallel(kind - LIGHT_LAMP)) {
        s = start_parallel(map, light.b, stored_spectrum(light.value), u);
    } else if (HAS_LAMPS && kind >= LIGHT_LAMP) {
        float pdf;
        aim(map, light.a, u, s.direction, pdf);
        s.origin = light.a;
        s.power = stored_spectrum(light.value) * (lamp_ray(kind - LIGHT_LAMP, light.a, light.b, light.c, light.a + s.direction).amount / pdf);
    } else if (HAS_LAMP_SURFACES) {
        s = start_on_surface(scene, map, light, source.light, vec2(to_unit(place.x), to_unit(place.y)), u);
    }
    s.power /= source.pmf * share;
    return s;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    FrameData frame = FrameRef(push.frame).frame;
    SceneData scene = wave_scene();
    PhotonMap map = PhotonMapRef(frame.photons).map;
    uint index = map.first_path + i, nth = index / map.paths;
    index -= nth * map.paths;
    PhotonRun run = PhotonRunArray(map.runs).at[nth];
#ifdef RESTAGE_SPECTRAL
    spectral_begin(scene, run.hero);
#endif
    uint cell;
    Start s = start_photon(scene, map, run.seed, index, cell);
    PhotonArray(map.deposits).at[i] = Photon(vec3(0), cell, vec4(-1, s.radiance, 0, 0), 0u); // for PhotonPilot
    bool alive = finite(s.power) && positive(max_component(s.power));
    RayArray rays = RayArray(frame.rays);
    rays.at[i].origin = s.origin;
    rays.at[i].direction = s.direction;
    rays.at[i].tfar = alive ? INFINITE : -1.0;
    rays.at[i].tnear = 0.0;
    ShadowArray(frame.shadows).at[i].tfar = -1.0;
    PathState path = PathState(Spectrum(1), 0.0, s.power, PATH_PHOTON | PATH_SPECULAR, 1.0, scene.camera_medium, run.seed, index);
    store_path(frame.paths, frame.fourths, i, path);
    store_begin(frame.paths, frame.fourths, i, path, run.hero);
}
