// SPDX-License-Identifier: Apache-2.0
#include "scene/same_material.hpp"

#include "base/file.hpp"

#include <string>

namespace restage::scene {

namespace {

constexpr int deepest = 64; // graphs have no cycles unless a file is broken

bool same_pixels(const PixelData& a, const PixelData& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels && a.values == b.values;
}

struct Pair {
    const Scene &a, &b;
    bool to_share = false; // origins have to be equal, too, and images need not be of one file

    bool images(Id<Image> x, Id<Image> y) const {
        const Image *i = a.images.find(x), *j = b.images.find(y);
        if (!i || !j) return !i && !j;
        const bool equal = to_share && i->data && j->data && same_pixels(*i->data, *j->data);
        const bool same = equal || (i->data == j->data && (i->data || !to_share || i->path == j->path)) ||
                          (!i->path.empty() && i->path == j->path);
        return same && i->encoding == j->encoding && (i->encoding != Encoding::gamma || i->gamma == j->gamma);
    }

    bool textures(Id<Texture> x, Id<Texture> y, int depth) const {
        const Texture *s = a.textures.find(x), *t = b.textures.find(y);
        if (!s || !t) return !s && !t;
        return depth < deepest && (!to_share || s->origin == t->origin) && s->type == t->type &&
               s->is_float == t->is_float && images(s->image, t->image) && params(s->params, t->params, depth + 1);
    }

    bool materials(Id<Material> x, Id<Material> y, int depth) const {
        const Material *m = a.materials.find(x), *n = b.materials.find(y);
        if (!m || !n) return !m && !n;
        return depth < deepest && (!to_share || m->origin == n->origin) && m->type == n->type &&
               params(m->params, n->params, depth + 1);
    }

    bool params(const ParamSet& p, const ParamSet& q, int depth) const { // in any order
        if (p.entries().size() != q.entries().size()) return false;
        for (const auto& [id, x] : p.entries()) {
            const Value* y = q.find(id);
            if (!y || x.type != y->type || bool(x.texture) != bool(y->texture)) return false;
            if (x.texture ? !textures(x.texture, y->texture, depth) : x.v != y->v) return false;
            if (x.i != y->i || x.text != y->text || !materials(x.material, y->material, depth)) return false;
        }
        return true;
    }
};

// Sums of hashes do not depend on the order of values.
struct Hash {
    const Scene& scene;

    template <class T>
    static std::uint64_t of(const T& value, std::uint64_t seed) {
        return hash64(&value, sizeof value, seed);
    }
    std::uint64_t image(Id<Image> id) const {
        const Image* i = scene.images.find(id);
        if (!i) return 1;
        std::uint64_t h = of(i->encoding, i->encoding == Encoding::gamma ? of(i->gamma, 2) : 2);
        if (!i->data) return hash64(i->path, h);
        h = of(i->data->width, of(i->data->height, of(i->data->channels, h)));
        return hash64(i->data->values.data(), i->data->values.size() * sizeof(float), h);
    }
    std::uint64_t texture(Id<Texture> id, int depth) const {
        const Texture* t = scene.textures.find(id);
        if (!t || depth >= deepest) return 3;
        return params(t->params, hash64(t->type, of(t->is_float, image(t->image))), depth + 1);
    }
    std::uint64_t material(Id<Material> id, int depth) const {
        const Material* m = scene.materials.find(id);
        return !m || depth >= deepest ? 4 : params(m->params, hash64(m->type), depth + 1);
    }
    std::uint64_t params(const ParamSet& set, std::uint64_t seed, int depth) const {
        std::uint64_t sum = seed;
        for (const auto& [id, v] : set.entries()) {
            std::uint64_t h = of(v.type, hash64(id));
            h = v.texture ? of(texture(v.texture, depth), h) : of(v.v, h);
            h = hash64(v.text, of(v.i, h));
            sum += v.material ? of(material(v.material, depth), h) : h;
        }
        return hash64(&sum, sizeof sum);
    }
};

} // namespace

std::uint64_t material_hash(const Scene& scene, Id<Material> id) {
    return scene.materials.find(id) ? Hash{scene}.material(id, 0) : 0;
}

bool same_material(const Scene& a, Id<Material> of_a, const Scene& b, Id<Material> of_b) {
    return a.materials.find(of_a) && b.materials.find(of_b) && Pair{a, b}.materials(of_a, of_b, 0);
}

bool identical_material(const Scene& a, Id<Material> of_a, const Scene& b, Id<Material> of_b) {
    return a.materials.find(of_a) && b.materials.find(of_b) && Pair{a, b, true}.materials(of_a, of_b, 0);
}

Id<Material> find_same_material(const Scene& in, const Scene& other, Id<Material> of_other) {
    const Material* wanted = other.materials.find(of_other);
    if (!wanted) return {};
    Id<Material> found;
    bool of_its_name = false;
    in.materials.each([&](Id<Material> id, const Material& m) {
        if (of_its_name || (found && m.name != wanted->name) || !same_material(in, id, other, of_other)) return;
        found = id;
        of_its_name = m.name == wanted->name;
    });
    return found;
}

} // namespace restage::scene
