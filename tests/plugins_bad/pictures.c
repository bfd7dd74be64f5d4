/* SPDX-License-Identifier: Apache-2.0 */
/* A material whose library needs the host's image decoder, and logs the result of one call. */
#include <restage/image.h>
#include <restage/material.h>
#include <stdio.h>

static int init(const RestageHost* host) {
    const RestageLog1* log = (const RestageLog1*)host->service(host, RESTAGE_LOG);
    const RestageImageService1* images = (const RestageImageService1*)host->service(host, RESTAGE_IMAGE_SERVICE);
    RestageDecodedImage image = {.size = sizeof image};
    char line[200];
    if (!log || !images) return 0;
    images->decode(host, NULL, 0, TEST_IMAGE, &image);
    snprintf(line, sizeof line, "%u x %u, %u of %u bits, problem \"%s\"", image.width, image.height, image.channels,
             image.bits, image.problem);
    log->log(host, RESTAGE_LOG_INFO, line);
    images->release(host, &image);
    return image.texels == NULL && image.owner == NULL;
}

static const RestageMaterial1 material = {
    .size = sizeof material, .type = "velvet", .label = "Velvet", .prefix = "velvet", .glsl_file = "velvet.glsl"};

RESTAGE_PLUGIN_INIT("org.example.velvet", "1.0.0", init, NULL, {RESTAGE_MATERIAL1, &material})
