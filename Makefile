# noh: characters in fixed memory. `make help` lists the targets.

MAKEFLAGS += --no-builtin-rules
comma   := ,

BUILD   ?= build
CC      ?= gcc
HOSTCC  ?= gcc
CXX     ?= g++
AR      ?= ar
OBJCOPY ?= objcopy
PKG     ?= pkg-config
DEPS    ?= 1
JOBS    ?= $(shell nproc 2>/dev/null || echo 2)
SAN     ?=
FUZZ_SECONDS ?= 60
ASSETS  ?= $(if $(NOH_ASSETS),$(NOH_ASSETS),../shared/assets)

ifeq ($(origin CC),default)
CC := gcc
endif
ifeq ($(origin CXX),default)
CXX := g++
endif

ifneq ($(words $(BUILD)),1)
$(error BUILD names one folder, without spaces: "$(BUILD)")
endif

# What every object needs: CFLAGS, CXXFLAGS, CPPFLAGS and LDFLAGS from outside are appended and replace nothing here.
# Contraction off: the CPU gives the same bits everywhere. No math errno: a square root is an instruction. A section
# for each function: what links with --gc-sections gets only what it calls.
# Warnings are errors in our checks (make check, CI), not in others' builds, of whose compilers and flags we know nothing.
CHECK_WERROR := $(if $(filter undefined,$(origin WERROR)),-Werror,$(WERROR))
WERROR   ?=
WARN     := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wvla $(WERROR)
FP       := -ffp-contract=off -fno-math-errno
SECTIONS := -ffunction-sections -fdata-sections
# With sanitizers gcc warns of truncations that cannot be; warnings are errors in the builds without them. UBSan's null
# and object-size take a quarter of the compiler's time and find little that ASan does not.
SANFLAGS := $(if $(SAN),-fsanitize=$(SAN) $(if $(NOH_LONG),,-fno-sanitize=null$(comma)object-size) -fno-sanitize-recover=all -fno-omit-frame-pointer -Wno-error)
OPT      ?= $(if $(SAN),-O1,-O2) -g1
ALL_CFLAGS   = -std=c99 $(OPT) $(WARN) $(FP) $(SECTIONS) $(SANFLAGS) $(CALLS) $(CPPFLAGS) $(CFLAGS)
ALL_CXXFLAGS = -std=c++17 $(OPT) -Wall -Wextra $(FP) $(SANFLAGS) $(CPPFLAGS) $(CXXFLAGS)
ALL_LDFLAGS  = $(SANFLAGS) $(LDFLAGS)
# Two hundred test programs are linked, two at once: lld takes a third of the time.
QUICK_LD    := $(if $(shell command -v ld.lld),-fuse-ld=lld -Wl$(comma)--threads=1)
INCLUDES := -Iruntime -Iplatform -Itools -Itools/noh -I$(BUILD)/gen
# Draco meshes in glTF are read where its library is.
HAVE_DRACO := $(shell $(PKG) --exists draco && echo y)
TOOL_LIBS := -ltinygltf -lmeshoptimizer -lstb $(if $(HAVE_DRACO),-ldraco) -ldl -lm
# What runs is printed as a word and a file; V=1 prints the commands.
Q        := $(if $(V),,@)
say       = $(if $(V),,@printf '  %-6s %s\n' $(1) $(2))
MACHINE  := $(shell $(CC) -dumpmachine)

# ---- what there is ----

# Folders are found, never listed: a file that is added or moved is built. sources DIR,PATTERN: DIR and two levels below.
sources     = $(sort $(foreach pattern,$(2),$(wildcard $(1)/$(pattern) $(1)/*/$(pattern) $(1)/*/*/$(pattern))))
# In the order in which the rooms include, which is also the order of the amalgam.
ROOMS      := $(shell sh tools/docs/rooms.sh order)
RUNTIME_C  := $(foreach room,$(ROOMS),$(call sources,runtime/$(room),*.c))
# template.c is for reading; the tests compile it.
PLATFORM_C := $(filter-out platform/template.c,$(sort $(wildcard platform/*.c)))
CONVERT_C  := $(call sources,tools/convert,*.c)
CONVERT_CC := $(call sources,tools/convert,*.cpp)
VIEW_NOT_C := $(call sources,tools/noh,view_without.c)
VIEW_C     := $(filter-out $(VIEW_NOT_C) %/cmd_view.c,$(call sources,tools/noh/view,*.c))
VIEW_CC    := $(call sources,tools/noh/view,*.cpp)
# The converter as a library has its own entry.
TOOL_C     := $(filter-out $(VIEW_NOT_C) $(VIEW_C) %/noh_convert.c,$(call sources,tools/noh,*.c))
DEMO_C     := $(call sources,tools/demo_assets,*.c)
EXAMPLE_C  := $(sort $(wildcard tools/examples/*.c))
STAGES     := vert geom frag
# .glsl files are for shaders of a game's own, too (runtime/gl/device/gl_shader_text.h).
SHADERS    := $(call sources,shaders_es,$(STAGES:%=*.%) *.glsl)
TOOL_SHADERS := $(call sources,tools/noh,$(STAGES:%=*.%))
# Under sanitizers, of what draws and of the program as a whole, only what is listed, and of the rest what is not listed
# with a minus (NOH_LONG=1: all).
SANITIZED  := $(if $(SAN),$(if $(NOH_LONG),,$(shell sed '/^\#/d' tests/sanitized.txt)))
TEST_C     := $(filter-out $(patsubst -%,tests/%.c,$(filter -%,$(SANITIZED))),\
                $(filter $(if $(SANITIZED),tests/unit/% tests/memory/% $(SANITIZED:%=tests/%.c),%),$(call sources,tests,test_*.c)))
VERSION    := $(shell sed -n 's/^\#define NOH_VERSION "\(.*\)"/\1/p' runtime/noh/base.h)

# `noh view` needs a window and panels; without their libraries the verb says which are missing.
VIEW_WITHOUT := $(strip $(if $(shell $(PKG) --exists glfw3 && echo y),,glfw3) $(if $(shell $(PKG) --exists imgui && echo y),,imgui))
ifeq ($(VIEW_WITHOUT),)
VIEW_O     := $(VIEW_C:%.c=$(BUILD)/%.o) $(VIEW_CC:%.cpp=$(BUILD)/%.o)
# GLFW is opened at run time (view/view_glfw.c): of it, the headers alone are needed.
VIEW_LIBS  := $(filter-out -lglfw%,$(shell $(PKG) --libs imgui))
else
VIEW_O     := $(VIEW_NOT_C:%.c=$(BUILD)/%.o)
endif

# Names of the converter as a library are hidden by GNU's tools; without them there is none.
CONVERT_LIB := $(if $(shell command -v $(OBJCOPY)),$(BUILD)/libnohconvert.a)

ASSERT_O   := $(RUNTIME_C:%.c=$(BUILD)/assert/%.o) $(BUILD)/gen/shaders.gen.o
RUNTIME_O  := $(if $(SAN),$(ASSERT_O),$(RUNTIME_C:%.c=$(BUILD)/%.o) $(BUILD)/gen/shaders.gen.o)
# The library's call graph comes with its objects (tests/check_stack.sh), unless a compiler cache gives back objects alone.
CALLS       =
ifeq ($(SAN)$(CC)$(filter -O2,$(OPT))$(findstring ccache,$(realpath $(shell command -v gcc))),gcc-O2)
$(RUNTIME_O): CALLS = -fcallgraph-info=su
endif
PLATFORM_O := $(PLATFORM_C:%.c=$(BUILD)/%.o)
# The C++ files of a folder are compiled as one, as most of the time goes into the headers that they share; what differs
# without Draco is compiled alone.
DRACO_CC   := tools/convert/gltf/gltf_draco.cpp
CONVERT_ROOMS := $(patsubst %/,%,$(sort $(dir $(CONVERT_CC))))
CONVERT_CC_O := $(CONVERT_ROOMS:%=$(BUILD)/%.o) $(DRACO_CC:%.cpp=$(BUILD)/%.o)
CONVERT_O  := $(CONVERT_CC_O) $(CONVERT_C:%.c=$(BUILD)/%.o)
TOOL_O     := $(TOOL_C:%.c=$(BUILD)/%.o) $(BUILD)/gen/tool_shaders.gen.o
DEMO_O     := $(DEMO_C:%.c=$(BUILD)/%.o)
$(DEMO_O): INCLUDES += -Itools/demo_assets
EXAMPLES   := $(EXAMPLE_C:tools/examples/%.c=$(BUILD)/examples/%)
TESTS      := $(TEST_C:tests/%.c=$(BUILD)/tests/%)
# The library as one source file, and the tests that are linked with it, too.
AMALGAM    := $(BUILD)/amalgam
AMALGAM_TESTS := $(patsubst tests/%.c,$(AMALGAM)/%,$(filter %/test_morph.c %/test_morph_finish.c %/test_controller.c %/test_graph.c %/test_skin.c %/test_null.c,$(TEST_C)))

# Skinning kernels and lanes built for other instruction sets, for `noh bench` and the tests.
KERNELS    := $(if $(filter x86_64%,$(MACHINE)),$(foreach set,sse2 avx2,$(BUILD)/kernel/skin_$(set).o $(BUILD)/kernel/ragdoll_lanes_$(set).o $(BUILD)/kernel/spring_lanes_$(set).o $(BUILD)/kernel/hair_lanes_$(set).o)) $(BUILD)/kernel/ragdoll_lanes_scalar.o $(BUILD)/kernel/spring_lanes_scalar.o $(BUILD)/kernel/hair_lanes_scalar.o

.PHONY: FORCE phones phones-update mutants mutants-seed mutants-seed-programs mutants-seed-lines check-long deps-long ear-tables install install-lib uninstall amalgam docs pictures examples sizes-update deps-docs deps-lint lint all demo demo-body demo-face demo-crowd view check check-build check-validator golden golden-day golden-update budgets budgets-update bench bench-lod help clean deps-build deps-check deps-view deps-cross deps-web deps-fuzz threads cross cross-tests npm web web-festival web-check web-serve web-bench look heads lib tests demo-run check-run fuzz sizes release release-check api-update
.SECONDARY:
.DELETE_ON_ERROR:

all: $(BUILD)/noh $(BUILD)/libnoh.a $(CONVERT_LIB) $(BUILD)/noh.1 $(BUILD)/noh.bash

help:
	@echo 'make            build/noh, build/libnoh.a and build/libnohconvert.a, the converter as a library'
	@echo 'make demo       install what is missing, build, make the mask, convert it, render it'
	@echo 'make demo-body  the same with the puppet, a figure that walks, bows, dances, falls and gets up'
	@echo 'make demo-crowd a square at a festival, with a thousand puppets who know where they are'
	@echo 'make demo-face  the puppet and the mask say a sentence: sound, strips, a film'
	@echo 'make view       the puppet in a window: sliders, clips, memory and times (FILE=PACK|MODEL: another)'
	@echo 'make check      install what is missing, build and run the tests'
	@echo 'make bench      ratios against the named baselines (the mask, and hero/head.glb and clips where they are)'
	@echo 'make check-validator DIR=...  what noh build says to the glTF validator'"'"'s broken files'
	@echo 'make bench-lod  of them only LOD levels against meshoptimizer'"'"'s'
	@echo 'make fuzz       fuzz the readers of packs, clips and wire forms (FUZZ_SECONDS=60 each; NOH_LONG=1: of models, too), needs clang'
	@echo 'make phones     the shaders by the compilers of six GPUs of phones, against tools/phones/table.txt'
	@echo 'make check-long  all that .ci/run does in its long form: hours; and memcheck, paths by gcc and clang, AFL++'
	@echo 'make mutants    each technique of tests/README.md broken in turn: its test has to fail (NOH_TEST=NAME: some)'
	@echo 'make mutants-seed SEED=1 COUNT=200  errors anywhere in runtime/, chosen by SEED: at least 95 % have to fail a test'
	@echo 'make threads    poses on four threads under ThreadSanitizer'
	@echo 'make golden     the same bits of ten seconds by every compiler and processor here; golden-day: 24 hours (NOH_DAY_S); golden-update: a new table'
	@echo 'make budgets    what the demo characters take, to the byte, against a table; budgets-update: a new table'
	@echo 'make cross      the library and its CPU tests for aarch64, armv7, wasm and Windows (qemu, node, Wine)'
	@echo 'make web        the page, WebGL 2 (WEB_PACK=PACK: for another pack); make web-serve, web-check, web-bench'
	@echo 'make npm        the package noh-character for npm: build/npm/'
	@echo 'make heads      heads of several makers alive: how often they stand still, and strips (node)'
	@echo 'make look       heads and bodies by noh, three.js and model-viewer in the same light: a sheet, and figures'
	@echo 'make lint       prose.sh, clang-tidy and cppcheck over runtime/, platform/ and tools/'
	@echo 'make sizes      code and data of the library for each processor, with what changed since the last commit'
	@echo 'make amalgam    the library as one source file, $(BUILD)/amalgam/noh.c, and its public headers'
	@echo 'make docs       the API reference out of the headers, $(BUILD)/docs/html/index.html'
	@echo 'make pictures   the pictures of the documents, drawn again (PICTURES=WORD: some)'
	@echo 'make install    PREFIX=/usr/local DESTDIR=: the tools, and the library for pkg-config and CMake; make uninstall'
	@echo 'make install-lib  the library alone, without a C++ compiler (CC=, AR=: for another processor)'
	@echo 'make release    source archive, Debian and npm packages, port, recipe, SPDX list and checksums: build/release/;'
	@echo '                make api-update: the API that later versions are compared with'
	@echo 'make release-check  the Debian packages twice, lintian, installed into a minimal Debian, used, removed: root, debhelper,'
	@echo '                lintian, debootstrap; two whole builds'
	@echo 'make clean      remove $(BUILD)'
	@echo ''
	@echo 'CFLAGS, CXXFLAGS, CPPFLAGS and LDFLAGS are appended to the flags that are needed; OPT="-O2 -g" can be replaced, and'
	@echo 'WERROR=-Werror makes warnings errors. Objects do not know their flags: use another BUILD for others.'
	@echo 'V=1 prints the commands. DEPS=0 installs nothing. SAN=address,undefined builds with sanitizers (use another BUILD).'
	@echo 'ASSETS=DIR is where the tests look for models that are not ours to ship. NOH_TEST=NAME runs only those tests.'

# ---- the library ----

lib: $(BUILD)/libnoh.a

$(BUILD)/libnoh.a: $(RUNTIME_O)
	@rm -f $@
	$(call say,AR,$@)
	$(Q)$(AR) rcsD $@ $^

# The same with every assert on, for the tests and all that sanitizers watch: what ships has none.
$(BUILD)/assert/libnoh.a: $(ASSERT_O)
	@rm -f $@
	$(call say,AR,$@)
	$(Q)$(AR) rcsD $@ $^

$(BUILD)/assert/%.o: %.c | $(BUILD)/gen/shaders.gen.h
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_ASSERT_LEVEL=2 -MMD -MP -c $< -o $@

$(BUILD)/%.o: %.c | $(BUILD)/gen/shaders.gen.h $(BUILD)/gen/tool_shaders.gen.h
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -MMD -MP -c $< -o $@

$(BUILD)/gen/%.o: $(BUILD)/gen/%.c
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -MMD -MP -c $< -o $@

$(BUILD)/gen/shaders.gen.c: $(SHADERS) $(BUILD)/embed
	@mkdir -p $(@D)
	$(call say,EMBED,$@)
	$(Q)$(BUILD)/embed -o $@ -d $(BUILD)/gen/shaders.embed.d $(SHADERS)
$(BUILD)/gen/shaders.gen.h: $(BUILD)/gen/shaders.gen.c ;

$(BUILD)/gen/tool_shaders.gen.c: $(TOOL_SHADERS) $(BUILD)/embed
	@mkdir -p $(@D)
	$(call say,EMBED,$@)
	$(Q)$(BUILD)/embed -o $@ -d $(BUILD)/gen/tool_shaders.embed.d $(TOOL_SHADERS)
$(BUILD)/gen/tool_shaders.gen.h: $(BUILD)/gen/tool_shaders.gen.c ;

# Installed, too: where it is compiled for this machine, with the caller's flags.
HOST_FLAGS = $(if $(filter $(CC),$(HOSTCC)),$(CPPFLAGS) $(CFLAGS) $(LDFLAGS))
$(BUILD)/embed: tools/embed/embed.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(HOSTCC) -std=c99 -O2 -g1 $(WARN) $(SANFLAGS) $(HOST_FLAGS) $< -o $@

include tools/mk/tools.mk
include tools/mk/checks.mk
include tools/mk/mutants.mk
include tools/mk/web.mk
include tools/mk/install.mk

clean:
	rm -rf $(BUILD)

-include $(shell find $(BUILD) -path $(BUILD)/phones -prune -o -path $(BUILD)/bare -prune -o -name '*.d' -print 2>/dev/null)
