/* SPDX-License-Identifier: Apache-2.0 */
/* Service "restage.image/1": the host's image decoder, for plugins that need pixels: a channel, the alpha, the mean, or
 * an image embedded in another file. All images of a scene are read by it, so that it accepts and rejects the same
 * files everywhere. A plugin that requires it lists it in its manifest,
 *
 *   "needs": {"host": ">=0.2", "interfaces": ["restage.image/1"]}
 *
 * and gets it in init: host->service(host, RESTAGE_IMAGE_SERVICE). */
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
    uint32_t bits; /* bits per channel: 8 (uint8_t), 16 (uint16_t): as stored, not linear; 32 (float): linear */
    const void* texels; /* width * height * channels values, without gaps between rows */
    const char* problem; /* "" or what is wrong with the file; texels may be present even so */
    void* owner; /* private to the host */
} RestageDecodedImage;

typedef struct RestageImageService1 {
    RESTAGE_SIZE(RestageImageService1);
    /* [worker], several threads at a time. Decodes PNG, JPEG, WebP, BMP, TGA, HDR, EXR and PFM, identified by content.
     * `bytes`: the file's contents, up to 5 GiB, and `name` is used in messages; or NULL, and `name` is the path of the
     * file to read. 1 = done; 0 = failed: `out->problem` says why and names the file, the rest is zero. What `out`
     * points to is valid until it is released, which is required in both cases before shutdown returns. */
    int (*decode)(const RestageHost* host, const void* bytes, uint64_t length, const char* name,
                  RestageDecodedImage* out);
    /* [any] Zeroes `image`. Does nothing if it is NULL or already zeroed. */
    void (*release)(const RestageHost* host, RestageDecodedImage* image);
} RestageImageService1;

#ifdef __cplusplus
}
#endif
#endif
