# SPDX-License-Identifier: Apache-2.0
# Short names for the scripts in tools/.
.PHONY: run test build bench format
run test build bench format:
	@tools/$@
