/* SPDX-License-Identifier: Apache-2.0 */
/* Service "restage.image/1": the host's decoder of pictures, for a plugin that must look inside one: a channel of it,
 * its alpha, its mean, or a picture that is no file of its own. It is the one that reads every picture of a scene, so
 * what it takes and refuses is the same everywhere. A plugin that cannot do without lists it in its manifest,
 *
 *   "needs": {"host": ">=0.2", "interfaces": ["restage.image/1"]}
 *
 * and asks for it in init: host->service(host, RESTAGE_IMAGE_SERVICE). */
#ifndef RESTAGE_IMAGE_H
#define RESTAGE_IMAGE_H

#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_IMAGE_SERVICE "restage.image/1"

typedef struct RestageDecodedImage {
    RESTAGE_SIZE(RestageDecodedImage);
    uint32_t width, height; /* row 0 is the top */
    uint32_t channels; /* 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha */
    uint32_t bits; /* of a number: 8 (uint8_t), 16 (uint16_t) as stored, not linear; 32 (float): linear */
    const void* texels; /* width * height * channels numbers, without gaps between the rows */
    const char* problem; /* "" or what is wrong with the file; where there are texels, it could be shown all the same */
    void* owner; /* the host's own */
} RestageDecodedImage;

typedef struct RestageImageService1 {
    RESTAGE_SIZE(RestageImageService1);
    /* [worker], several threads at a time. Decodes PNG, JPEG, WebP, BMP, TGA, HDR, EXR and PFM, told apart by content.
     * `bytes`: the file's, up to 5 GiB, and `name` what messages call it; or NULL, and then `name` is the path of the
     * file to read. 1 = done. 0 = it cannot be: `out->problem` says why and names the file, the rest is zero. What
     * `out` points to is valid until it is released, which is due in both cases, before shutdown returns. */
    int (*decode)(const RestageHost* host, const void* bytes, uint64_t length, const char* name,
                  RestageDecodedImage* out);
    /* [any] Zeroes `image`. NULL and zeroed: nothing. */
    void (*release)(const RestageHost* host, RestageDecodedImage* image);
} RestageImageService1;

#ifdef __cplusplus
}
#endif
#endif
