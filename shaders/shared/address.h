// SPDX-License-Identifier: Apache-2.0
// `address`, of device memory, in GLSL; in C++ it is a type in types.h. Separate, so that the library can include
// functions without reserving that word in plugins.
#ifndef RESTAGE_SHARED_ADDRESS_H
#define RESTAGE_SHARED_ADDRESS_H
#ifndef __cplusplus
#define address uint64_t
#endif
#endif
