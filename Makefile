# The C side of qdist: libraries, header, C and C++ tests, proofs about the freestanding library. Rust alone needs only cargo.
#
# `./x` lists the targets, installs what they need and calls them; those that are called by themselves ask it to.

CARGO ?= cargo
CC ?= cc
CXX ?= c++
WARNINGS = -Wall -Wextra -Wpedantic -Wconversion
CFLAGS_TEST = -std=c99 $(WARNINGS) -Werror -O1 -g -Iinclude
CXXFLAGS_TEST = -std=c++17 $(WARNINGS) -Werror -O1 -g -Iinclude

target := $(or $(CARGO_TARGET_DIR),target)
lib := $(target)/release/libqdist.a
lib_std := $(target)/debug/libqdist.a
lib_mesh := $(target)/hosted/libqdist.a
system_libs := -lpthread -ldl -lm
out := $(target)/c
capi := $(CARGO) rustc --quiet --locked --package qdist-capi --lib --crate-type staticlib
version := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
# Sees to it that what the target needs is here.
need = @./x need $@ && mkdir -p $(out)

.PHONY: all lib lib-std lib-mesh header header-check margins demo demo-mesh test test-c freestanding purity stack instructions embedded lib-arm figures compare bench-dq bench-grasp bench-pdg bench-depth report report-quick asked record record-compare clean
all: lib

lib:
	$(need)
	@echo "$(lib): no std, release; built where a source is newer, in about a minute"
	@$(capi) --release --features grasp,panic-handler && cp $(target)/release/libqdist_capi.a $(lib)

lib-std:
	$(need)
	@echo "$(lib_std): std, debug; built where a source is newer"
	@$(capi) --features c-allocator && cp $(target)/debug/libqdist_capi.a $(lib_std)

lib-mesh:
	$(need)
	@echo "$(lib_mesh): std, meshes, release; built where a source is newer, in a minute or two"
	@$(capi) --profile hosted --features c-allocator && cp $(target)/hosted/libqdist_capi.a $(lib_mesh)

header:
	$(need)
	@echo "writing include/"
	@scripts/header.sh

header-check:
	$(need)
	@echo "checking that include/ is fresh"
	@scripts/header.sh --check

margins:
	$(need)
	@echo "taking each rounding margin away, to see a test fail (takes about ten minutes)"
	@scripts/margins.py

demo: lib
	@echo "building and running examples/depth.c"
	@$(CC) -std=c99 -O2 $(WARNINGS) -Iinclude examples/depth.c $(lib) -o $(out)/depth
	@$(out)/depth
	@echo "building and running examples/gripper.c"
	@$(CC) -std=c99 -O2 $(WARNINGS) -Iinclude examples/gripper.c $(lib) -lm -lpthread -o $(out)/gripper
	@$(out)/gripper

demo-mesh: lib-mesh
	@echo "building and running examples/mesh_depth.c"
	@$(CC) -std=c99 -O2 $(WARNINGS) -Iinclude examples/mesh_depth.c $(lib_mesh) $(system_libs) -o $(out)/mesh_depth
	@$(out)/mesh_depth
	@echo "building and running examples/haptic.c"
	@$(CC) -std=c99 -O2 $(WARNINGS) -Iinclude examples/haptic.c $(lib_mesh) $(system_libs) -o $(out)/haptic
	@$(out)/haptic

# $(call c-tests,directory,extra flags,library,command in front)
define c-tests
	@mkdir -p $(out)/$(1)
	@$(CC) $(CFLAGS_TEST) $(2) ffi-tests/smoke.c $(3) -lm -o $(out)/$(1)/smoke
	@$(CC) $(CFLAGS_TEST) $(2) ffi-tests/bodies.c $(3) -lm -o $(out)/$(1)/bodies
	@$(CC) $(CFLAGS_TEST) $(2) ffi-tests/bad_arguments.c $(3) -lm -o $(out)/$(1)/bad_arguments
	@$(CC) $(CFLAGS_TEST) $(2) -DCARGO_VERSION='"$(version)"' ffi-tests/abi.c $(3) -lm -o $(out)/$(1)/abi
	@$(CXX) $(CXXFLAGS_TEST) $(2) ffi-tests/smoke_cpp.cpp $(3) -lm -o $(out)/$(1)/smoke_cpp
	@for test in bodies grasp callbacks environment sweep; do \
	    $(CC) $(CFLAGS_TEST) $(2) ffi-tests/$$test.c $(3) -lm -o $(out)/$(1)/$$test || exit 1; done
	@for test in smoke bodies bad_arguments abi grasp callbacks environment sweep smoke_cpp; do $(4) $(out)/$(1)/$$test || exit 1; done
endef

# $(call mesh-tests,directory,extra flags,library)
define mesh-tests
	@mkdir -p $(out)/$(1)
	@$(CC) $(CFLAGS_TEST) $(2) ffi-tests/mesh.c $(3) $(system_libs) -o $(out)/$(1)/mesh
	@$(CXX) $(CXXFLAGS_TEST) $(2) ffi-tests/mesh_cpp.cpp $(3) $(system_libs) -o $(out)/$(1)/mesh_cpp
	@for test in mesh mesh_cpp; do $(out)/$(1)/$$test || exit 1; done
endef

test-c: lib lib-std lib-mesh
	$(need)
	@echo "C and C++ tests with the freestanding library"
	$(call c-tests,plain,,$(lib),)
	@$(CC) $(CFLAGS_TEST) ffi-tests/float128.c -Wl,--no-gc-sections $(lib) -o $(out)/plain/float128 && $(out)/plain/float128
	@echo "C and C++ tests of meshes with the hosted library"
	$(call mesh-tests,plain,,$(lib_mesh))
	@echo "README's examples in C"
	@scripts/readme.sh $(lib) $(lib_mesh) $(out)/readme
	@echo "C and C++ tests with sanitizers and the hosted library"
	$(call c-tests,sanitized,-fsanitize=address$(comma)undefined -fno-sanitize-recover=all,$(lib_std) -lpthread -ldl,)
	$(call mesh-tests,sanitized,-fsanitize=address$(comma)undefined -fno-sanitize-recover=all,$(lib_std))
	@if command -v valgrind >/dev/null; then \
	    echo "C and C++ tests under valgrind"; \
	    for test in smoke bodies bad_arguments abi grasp callbacks smoke_cpp mesh mesh_cpp; do \
	        valgrind --quiet --error-exitcode=1 --leak-check=full $(out)/plain/$$test || exit 1; \
	    done; \
	else echo "SKIPPED: valgrind is not there"; fi
comma := ,

freestanding: lib
	@if [ "$$(uname -sm)" = "Linux x86_64" ]; then \
	    echo "linking and running a program without libc"; \
	    $(CC) -std=c99 -O2 -Wall -Wextra -Werror -ffreestanding -fno-builtin -fno-stack-protector -nostdlib -static \
	        -Wl,--gc-sections -Iinclude ffi-tests/freestanding.c $(lib) -o $(out)/freestanding && \
	    $(out)/freestanding && echo "freestanding: 1 passed, 0 failed"; \
	else echo "SKIPPED: the program without libc knows Linux on x86-64 only"; fi

purity:
	$(need)
	@scripts/purity.sh

stack: lib
	@$(CC) -std=gnu99 -O2 -Wall -Wextra -Iinclude ffi-tests/stack.c $(lib) -o $(out)/stack
	@$(out)/stack

# WRITE=1 renews the golden numbers.
instructions: lib
	$(need)
	@$(CC) -std=c99 -O2 $(WARNINGS) -Iinclude ffi-tests/instructions.c $(lib) -lm -o $(out)/instructions
	@scripts/instructions.sh $(out)/instructions $(if $(WRITE),write)

# For Cortex-M: programs, run in QEMU; WRITE=1 renews the golden numbers. And a library of chosen functions.
embedded: OUT = out/embedded
embedded:
	$(need)
	@CARGO_TARGET_DIR=$(abspath $(target)) scripts/embedded.py $(OUT) $(if $(WRITE),--write)

lib-arm:
	$(need)
	@CARGO_TARGET_DIR=$(abspath $(target)) scripts/embedded.py --lib $(CPU) --only "$(ONLY)"

figures: lib lib-mesh
	@$(CC) -std=c99 -O2 $(WARNINGS) -Iinclude ffi-tests/figures.c $(lib) -lm -o $(out)/figures
	@$(out)/figures
	@$(CC) -std=c99 -O2 $(WARNINGS) -Iinclude ffi-tests/figures_mesh.c $(lib_mesh) $(system_libs) -o $(out)/figures_mesh
	@$(out)/figures_mesh

# CHECK=--check makes a wrong or missing bracket an error.
CASES ?= $(or $(wildcard ../shared/data/convex/*.txt),$(wildcard tests/data/*.txt))
OUT ?= out/compare
compare: lib
	$(need)
	@echo "building compare"
	@$(CXX) -std=c++17 -O2 -Wall -Wextra -Iinclude $(peer_includes) ffi-tests/compare.cpp ffi-tests/qdist_query.cpp ffi-tests/peers.cpp \
	    ffi-tests/cases.cpp $(lib) -lfcl -lccd -lqhullcpp -lqhull_r -o $(out)/compare
	@mkdir -p $(OUT)
	@echo "comparing; results go to $(OUT)"
	@$(out)/compare $(OUT) $(CASES)
	@python3 ffi-tests/compare_table.py $(CHECK) $(OUT)/compare.csv $(CASES)
peer_includes = -isystem /usr/include/eigen3

bench-dq: OUT = out/dq
bench-dq:
	$(need)
	@echo "measuring d_Q; results go to $(OUT)"
	@$(CARGO) bench --quiet --locked --package qdist-benches --bench dq -- $(if $(QUICK),--quick) "$(abspath $(OUT))"

bench-grasp: OUT = out/grasp
bench-grasp:
	$(need)
	@echo "measuring grasps; results go to $(OUT)"
	@$(CARGO) bench --quiet --locked --package qdist-benches --bench grasp -- $(if $(QUICK),--quick) "$(abspath $(OUT))"

bench-pdg: OUT = out/pdg
bench-pdg:
	$(need)
	@echo "building FCL's part"
	@$(CXX) -std=c++17 -O3 -Wall -Wextra $(peer_includes) benches/pdg/fcl.cpp -lfcl -lccd -o $(out)/pdg_fcl
	@echo "measuring depths of meshes; results go to $(OUT)"
	@$(CARGO) bench --quiet --locked --package qdist-benches --bench pdg -- $(if $(QUICK),--quick) --fcl "$(abspath $(out))/pdg_fcl" "$(abspath $(OUT))"

# In a virtual environment of its own: Python's packages that draw, and the peers that come with them.
venv := $(abspath $(target))/report-venv
$(venv)/.done: benches/report/requirements.txt
	@./x need report
	@echo "installing what the report needs from PyPI into $(venv)"
	@python3 -m venv $(venv) && $(venv)/bin/pip install --quiet --disable-pip-version-check -r $< && touch $@
report_for = cd benches && CARGO_TARGET_DIR=$(abspath $(target)) $(venv)/bin/python -m report $(abspath $(OUT))

report: OUT = out/report
report: takes = $(if $(PART),the whole report about 45 minutes,about 45 minutes)
report-quick: OUT = out/report-quick
report-quick: takes = about 5 minutes
report report-quick: asked lib $(venv)/.done
	$(need)
	@echo "measuring ($(takes), and some minutes more to build it first); the page goes to $(abspath $(OUT))"
	@$(report_for) $(if $(filter report-quick,$@)$(QUICK),--quick) $(if $(PART),--part $(PART)) $(if $(AGAIN),--again) $(if $(COPY),--copy)

bench-depth: OUT = out/depth
bench-depth: asked lib $(venv)/.done
	$(need)
	@echo "measuring depth of bodies (about $(if $(QUICK),two minutes,14 minutes)); results go to $(abspath $(OUT))"
	@$(report_for) $(if $(QUICK),--quick) --part depth --data-only --flat $(if $(AGAIN),--again)

# Looks at what these are told before anything is built.
asked:
	@./x need $(firstword $(filter report report-quick bench-depth,$(MAKECMDGOALS)) report)

record: OUT = out/record
record:
	$(need)
	@echo "writing every answer to the last bit; the records go to $(OUT)"
	@$(CARGO) run --quiet --release --locked --package qdist-benches --example record -- $(if $(PART),--part $(PART)) "$(abspath $(OUT))"

record-compare:
	$(need)
	@scripts/record_compare.sh $(A) $(B)

test:
	@scripts/test.sh

clean:
	@$(CARGO) clean
