# SPDX-License-Identifier: Apache-2.0
"""`restage bench`: error against samples and CPU time, of configurations of Restage and of other renderers on the same scenes,
and how speed and memory grow; as JSON, SVG and one HTML page."""
