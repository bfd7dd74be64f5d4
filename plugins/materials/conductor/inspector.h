/* SPDX-License-Identifier: Apache-2.0 */
#ifndef CONDUCTOR_INSPECTOR_H
#define CONDUCTOR_INSPECTOR_H

#include <restage/inspector.h>

extern const RestageInspector1 conductor_inspector;

#endif
