# noh: characters in fixed memory. `make help` lists the targets.

MAKEFLAGS += --no-builtin-rules

BUILD   ?= build
CC      ?= gcc
HOSTCC  ?= gcc
CXX     ?= g++
AR      ?= ar
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
# With sanitizers gcc warns of truncations that cannot be; warnings are errors in the builds without them.
SANFLAGS := $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer -Wno-error)
OPT      ?= $(if $(SAN),-O1,-O2) -g1
ALL_CFLAGS   = -std=c99 $(OPT) $(WARN) $(FP) $(SECTIONS) $(SANFLAGS) $(CPPFLAGS) $(CFLAGS)
ALL_CXXFLAGS = -std=c++17 $(OPT) -Wall -Wextra $(FP) $(SANFLAGS) $(CPPFLAGS) $(CXXFLAGS)
ALL_LDFLAGS  = $(SANFLAGS) $(LDFLAGS)
# Two hundred test programs are linked: lld takes a third of the time.
QUICK_LD    := $(if $(shell command -v ld.lld),-fuse-ld=lld)
INCLUDES := -Iruntime -Iplatform -Itools -Itools/noh -I$(BUILD)/gen
# Draco meshes in glTF are read where its library is.
HAVE_DRACO := $(shell $(PKG) --exists draco && echo y)
HAVE_ASSIMP := $(shell $(PKG) --exists assimp && echo y)
TOOL_LIBS := -ltinygltf -lmeshoptimizer -lstb $(if $(HAVE_DRACO),-ldraco) $(if $(HAVE_ASSIMP),-lassimp) -ldl -lm
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
CONVERT_CC := $(filter-out $(if $(HAVE_ASSIMP),,tools/convert/fbx/fbx_a% tools/convert/fbx/fbx_m% tools/convert/fbx/fbx_s%),$(call sources,tools/convert,*.cpp))
VIEW_NOT_C := $(call sources,tools/noh,view_without.c)
VIEW_C     := $(filter-out $(VIEW_NOT_C) %/cmd_view.c,$(call sources,tools/noh/view,*.c))
VIEW_CC    := $(call sources,tools/noh/view,*.cpp)
TOOL_C     := $(filter-out $(VIEW_NOT_C) $(VIEW_C),$(call sources,tools/noh,*.c))
DEMO_C     := $(call sources,tools/demo_assets,*.c)
EXAMPLE_C  := $(sort $(wildcard tools/examples/*.c))
STAGES     := vert geom frag
# .glsl files are for shaders of a game's own, too (runtime/gl/device/gl_shader_text.h).
SHADERS    := $(call sources,shaders_es,$(STAGES:%=*.%) *.glsl)
TOOL_SHADERS := $(call sources,tools/noh,$(STAGES:%=*.%))
# Under sanitizers, of what draws and of the program as a whole, only what is listed (NOH_LONG=1: all).
SANITIZED  := $(if $(SAN),$(if $(NOH_LONG),,$(shell sed '/^\#/d' tests/sanitized.txt)))
TEST_C     := $(filter $(if $(SANITIZED),tests/unit/% tests/memory/% $(SANITIZED:%=tests/%.c),%),$(call sources,tests,test_*.c))
VERSION    := $(shell sed -n 's/^\#define NOH_VERSION "\(.*\)"/\1/p' runtime/core/base/version.h)

# `noh view` needs a window and panels; without their libraries the verb says which are missing.
VIEW_WITHOUT := $(strip $(if $(shell $(PKG) --exists glfw3 && echo y),,glfw3) $(if $(shell $(PKG) --exists imgui && echo y),,imgui))
ifeq ($(VIEW_WITHOUT),)
VIEW_O     := $(VIEW_C:%.c=$(BUILD)/%.o) $(VIEW_CC:%.cpp=$(BUILD)/%.o)
# GLFW is opened at run time (view/view_glfw.c): of it, the headers alone are needed.
VIEW_LIBS  := $(filter-out -lglfw%,$(shell $(PKG) --libs imgui))
else
VIEW_O     := $(VIEW_NOT_C:%.c=$(BUILD)/%.o)
endif

ASSERT_O   := $(RUNTIME_C:%.c=$(BUILD)/assert/%.o) $(BUILD)/gen/shaders.gen.o
RUNTIME_O  := $(if $(SAN),$(ASSERT_O),$(RUNTIME_C:%.c=$(BUILD)/%.o) $(BUILD)/gen/shaders.gen.o)
PLATFORM_O := $(PLATFORM_C:%.c=$(BUILD)/%.o)
CONVERT_O  := $(CONVERT_C:%.c=$(BUILD)/%.o) $(CONVERT_CC:%.cpp=$(BUILD)/%.o)
TOOL_O     := $(TOOL_C:%.c=$(BUILD)/%.o) $(BUILD)/gen/tool_shaders.gen.o
DEMO_O     := $(DEMO_C:%.c=$(BUILD)/%.o)
$(DEMO_O): INCLUDES += -Itools/demo_assets
comma      := ,
EXAMPLES   := $(EXAMPLE_C:tools/examples/%.c=$(BUILD)/examples/%)
TESTS      := $(TEST_C:tests/%.c=$(BUILD)/tests/%)
# The library as three files, and the tests that are linked with it, too.
AMALGAM    := $(BUILD)/amalgam
AMALGAM_TESTS := $(patsubst tests/%.c,$(AMALGAM)/%,$(filter %/test_morph.c %/test_morph_finish.c %/test_controller.c %/test_graph.c %/test_skin.c %/test_null.c,$(TEST_C)))

# Skinning kernels and lanes built for other instruction sets, for `noh bench` and the tests.
KERNELS    := $(if $(filter x86_64%,$(MACHINE)),$(foreach set,sse2 avx2,$(BUILD)/kernel/skin_$(set).o $(BUILD)/kernel/ragdoll_lanes_$(set).o $(BUILD)/kernel/spring_lanes_$(set).o $(BUILD)/kernel/hair_lanes_$(set).o)) $(BUILD)/kernel/ragdoll_lanes_scalar.o $(BUILD)/kernel/spring_lanes_scalar.o $(BUILD)/kernel/hair_lanes_scalar.o

.PHONY: FORCE mutants check-long deps-long ear-tables install install-lib uninstall amalgam docs examples sizes-update deps-docs deps-lint lint all demo demo-body demo-face demo-crowd view check check-validator golden golden-update budgets budgets-update bench bench-lod help clean deps-build deps-check deps-view deps-cross deps-web deps-fuzz threads cross cross-tests npm web web-festival web-check web-serve web-bench look-compare lib tests demo-run check-run fuzz sizes
.SECONDARY:
.DELETE_ON_ERROR:

all: $(BUILD)/noh $(BUILD)/libnoh.a $(BUILD)/noh.1 $(BUILD)/noh.bash

help:
	@echo 'make            build/noh and build/libnoh.a'
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
	@echo 'make check-long  all that .ci/run does in its long form: hours; and memcheck, paths by gcc and clang, AFL++'
	@echo 'make mutants    each technique of tests/README.md broken in turn: its test has to fail (NOH_TEST=NAME: some)'
	@echo 'make threads    poses on four threads under ThreadSanitizer'
	@echo 'make golden     the same bits of ten seconds by every compiler and processor here; golden-update: a new table'
	@echo 'make budgets    what the demo characters take, to the byte, against a table; budgets-update: a new table'
	@echo 'make cross      the library and its CPU tests for aarch64, armv7 and wasm (qemu, node)'
	@echo 'make web        the page, WebGL 2 (WEB_PACK=PACK: for another pack); make web-serve, web-check, web-bench'
	@echo 'make npm        the package noh-character for npm: build/npm/'
	@echo 'make look-compare  pictures beside three.js in the light of a room'
	@echo 'make lint       clang-tidy and cppcheck over runtime/, platform/ and tools/'
	@echo 'make sizes      code and data of the library for each processor, with what changed since the last commit'
	@echo 'make amalgam    the library as three files, $(BUILD)/amalgam/noh.c, noh.h and noh_gl.h'
	@echo 'make docs       the API reference out of the headers, $(BUILD)/docs/html/index.html'
	@echo 'make install    PREFIX=/usr/local DESTDIR=: the tools, and the library for pkg-config and CMake; make uninstall'
	@echo 'make install-lib  the library alone, without a C++ compiler (CC=, AR=: for another processor)'
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

$(BUILD)/embed: tools/embed/embed.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(HOSTCC) -std=c99 -O2 $(WARN) $(SANFLAGS) $< -o $@

# ---- the tools ----

# The C++ side is tinygltf's; its headers are not held to our warnings.
$(BUILD)/tools/convert/%.o: tools/convert/%.cpp
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -Iruntime -Itools -isystem /usr/include/stb -MMD -MP -c $< -o $@

$(BUILD)/tools/convert/gltf/gltf_draco.o: ALL_CXXFLAGS += $(if $(HAVE_DRACO),-DNOH_DRACO)
$(BUILD)/tools/convert/gltf/gltf_draco.o: $(BUILD)/gen/with_draco

$(BUILD)/tools/convert/fbx/%.o: ALL_CXXFLAGS += $(if $(HAVE_ASSIMP),-DNOH_ASSIMP)
$(patsubst %.cpp,$(BUILD)/%.o,$(wildcard tools/convert/fbx/*.cpp)): $(BUILD)/gen/with_assimp

# Change when Draco or Assimp comes or goes.
$(BUILD)/gen/with_draco: FORCE
	@mkdir -p $(@D)
	@echo '$(HAVE_DRACO)' | cmp -s - $@ || echo '$(HAVE_DRACO)' >$@
$(BUILD)/gen/with_assimp: FORCE
	@mkdir -p $(@D)
	@echo '$(HAVE_ASSIMP)' | cmp -s - $@ || echo '$(HAVE_ASSIMP)' >$@

# One file of the library, wherever it lies, for an instruction set, its entry renamed.
kernel_c    = $(firstword $(filter %/$(1).c,$(RUNTIME_C)))
$(BUILD)/kernel/clip_sample_%.o: $(call kernel_c,clip_sample)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -m$* -Dnoh_clip_blend_frames=noh_clip_blend_frames_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/skin_%.o: $(call kernel_c,skin)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -m$* -DNOH_SKIN_VERTICES=noh_skin_vertices_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/ragdoll_lanes_scalar.o: $(call kernel_c,ragdoll_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_RAGDOLL_SCALAR -DNOH_RAGDOLL_STEP=noh_ragdoll_step_dolls_scalar -MMD -MP -c $< -o $@

$(BUILD)/kernel/ragdoll_lanes_%.o: $(call kernel_c,ragdoll_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -m$* -DNOH_RAGDOLL_STEP=noh_ragdoll_step_dolls_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/spring_lanes_scalar.o: $(call kernel_c,spring_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_SPRING_SCALAR -DNOH_SPRING_STEP=noh_spring_step_scalar -DNOH_SPRING_ROTATIONS=noh_spring_rotations_scalar -MMD -MP -c $< -o $@

$(BUILD)/kernel/spring_lanes_%.o: $(call kernel_c,spring_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -m$* -DNOH_SPRING_STEP=noh_spring_step_$* -DNOH_SPRING_ROTATIONS=noh_spring_rotations_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/hair_lanes_scalar.o: $(call kernel_c,hair_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_HAIR_SCALAR -DNOH_HAIR_STEP=noh_hair_step_scalar -DNOH_HAIR_POINTS=noh_hair_points_scalar -MMD -MP -c $< -o $@

$(BUILD)/kernel/hair_lanes_%.o: $(call kernel_c,hair_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -m$* -DNOH_HAIR_STEP=noh_hair_step_$* -DNOH_HAIR_POINTS=noh_hair_points_$* -MMD -MP -c $< -o $@

$(BUILD)/tools/noh/view/%.o: tools/noh/view/%.cpp | $(BUILD)/gen/shaders.gen.h
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) $(INCLUDES) $(patsubst -I%,-isystem %,$(shell $(PKG) --cflags glfw3 imgui)) -MMD -MP -c $< -o $@

$(VIEW_NOT_C:%.c=$(BUILD)/%.o): $(VIEW_NOT_C) $(BUILD)/gen/view_without
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_VIEW_WITHOUT='"$(subst $() , and ,$(VIEW_WITHOUT))"' -MMD -MP -c $< -o $@

# Changes when what is missing does: noh is then linked again.
$(BUILD)/gen/view_without: FORCE
	@mkdir -p $(@D)
	@echo '$(VIEW_WITHOUT)' | cmp -s - $@ || echo '$(VIEW_WITHOUT)' >$@
FORCE:

$(BUILD)/noh: $(TOOL_O) $(VIEW_O) $(CONVERT_O) $(PLATFORM_O) $(KERNELS) $(BUILD)/libnoh.a $(BUILD)/gen/view_without
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(filter %.o %.a,$^) -o $@ $(VIEW_LIBS) $(TOOL_LIBS)

# The same as on a machine that has only what it must: no Draco, no Assimp, no window. For the tests.
WITHOUT_CC := tools/convert/gltf/gltf_draco.cpp tools/convert/fbx/fbx_read.cpp
WITHOUT_O  := $(WITHOUT_CC:%.cpp=$(BUILD)/without/%.o) $(VIEW_NOT_C:%.c=$(BUILD)/without/%.o)
$(BUILD)/without/%.o: %.cpp
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -Iruntime -Itools -isystem /usr/include/stb -MMD -MP -c $< -o $@
$(BUILD)/without/%.o: %.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_VIEW_WITHOUT='"glfw3 and imgui"' -MMD -MP -c $< -o $@
$(BUILD)/noh_without: $(TOOL_O) $(WITHOUT_O) $(filter-out $(BUILD)/tools/convert/fbx/% %/gltf_draco.o,$(CONVERT_O)) $(PLATFORM_O) $(KERNELS) $(BUILD)/libnoh.a
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $(filter %.o %.a,$^) -o $@ $(filter-out -ldraco -lassimp,$(TOOL_LIBS))

# The man page and the completion for bash come from the tables that the verbs read their options by.
$(BUILD)/noh.1: $(BUILD)/noh
	$(Q)$(BUILD)/noh help --man >$@
$(BUILD)/noh.bash: $(BUILD)/noh
	$(Q)$(BUILD)/noh help --bash >$@

$(BUILD)/demo_assets: $(DEMO_O)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_LDFLAGS) $^ -o $@ -lm

# Makes runtime/motion/clip/clip_tables.c out of raw clips; after a change of the clip format only.
$(BUILD)/clip_tables: $(BUILD)/tools/clip_tables/main.o $(CONVERT_O) $(PLATFORM_O) $(BUILD)/libnoh.a
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $^ -o $@ $(TOOL_LIBS)

# Makes runtime/life/face/ear_tables.c out of synthetic speech, after a change of the ear only: `make ear-tables` (ten
# minutes; `tools/deps.sh ear` installs the synthesisers).
TRAIN_EAR_O := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard tools/train_ear/*.c)))
$(BUILD)/train_ear: $(TRAIN_EAR_O) $(patsubst %,$(BUILD)/runtime/life/face/%.o,ear_cepstra ear_net phones)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_LDFLAGS) $^ -o $@ -lespeak-ng -lm

ear-tables: $(BUILD)/train_ear
	$(Q)cd $(BUILD) && ./train_ear $(CURDIR)/tools/train_ear/sentences.txt $(CURDIR)/tools/train_ear/phones.txt \
	    >ear_tables.c
	$(Q)mv $(BUILD)/ear_tables.c runtime/life/face/ear_tables.c

# Our LOD levels against meshoptimizer's; for `make bench`.
LOD_COMPARE_O := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard tools/lod_compare/*.c)))
$(BUILD)/lod_compare: $(LOD_COMPARE_O) $(CONVERT_O) $(PLATFORM_O) $(BUILD)/libnoh.a
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $^ -o $@ $(TOOL_LIBS)

$(BUILD)/mask.glb: $(BUILD)/demo_assets
	$(BUILD)/demo_assets $@

$(BUILD)/demo/puppet.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --puppet $@

$(BUILD)/demo/get_up.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --get-up $@

$(BUILD)/demo/arm.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --arm $@

$(BUILD)/mask.noh: $(BUILD)/mask.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --wrinkles auto --quiet
$(BUILD)/page/mask.noh: $(BUILD)/mask.glb $(BUILD)/noh
	@mkdir -p $(@D)
	$(BUILD)/noh build $< -o $@ --wrinkles auto --lod 4 --lod-fast --lod-color 1.2 --quiet
$(BUILD)/mask_levels.noh: $(BUILD)/mask.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --lod 4 --lod-fast --quiet
MASK_HAIR := tools/demo_assets/mask/mask.hair
$(BUILD)/wig.noh: $(BUILD)/mask.glb $(MASK_HAIR) $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --hair $(MASK_HAIR) --quiet
PUPPET_GRAPH := tools/demo_assets/puppet/puppet.graph
PUPPET_SPRINGS := tools/demo_assets/puppet/puppet.springs
$(BUILD)/demo/puppet.noh: $(BUILD)/demo/puppet.glb $(PUPPET_GRAPH) $(PUPPET_SPRINGS) $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --graph $(PUPPET_GRAPH) --springs $(PUPPET_SPRINGS) --wrinkles auto --quiet

# With what gets up from a fall.
$(BUILD)/demo/puppet_falls.noh: $(BUILD)/demo/puppet.glb $(BUILD)/demo/get_up.glb $(BUILD)/noh
	$(BUILD)/noh build $(filter %.glb,$^) -o $@ --quiet

$(BUILD)/demo/arm_transfer.noh: $(BUILD)/demo/arm.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --transfer 4 --quiet

PUPPET_MOVES := tools/demo_assets/puppet/moves.graph
$(BUILD)/demo/puppet_levels.noh: $(BUILD)/demo/puppet.glb $(PUPPET_MOVES) $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --lod 4 --lod-fast --graph $(PUPPET_MOVES) --quiet

# ---- demo, tests, benchmarks ----

deps-build:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build
deps-check:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build view check
deps-cross:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build cross
deps-web:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build web
deps-view:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build view
deps-fuzz:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build check fuzz

demo: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/mask.glb
	@sh tools/demo.sh $(BUILD)

demo-body: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/demo/puppet.glb $(BUILD)/demo/get_up.glb $(BUILD)/demo/arm.glb
	@NOH_ASSETS="$(ASSETS)" sh tools/demo_body.sh $(BUILD)

demo-face: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/demo/puppet.glb $(BUILD)/mask.noh
	@sh tools/demo_face.sh $(BUILD)

demo-crowd: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/demo_assets $(BUILD)/demo/puppet_levels.noh
	@sh tools/demo_crowd.sh $(BUILD)

FILE    ?= $(BUILD)/demo/puppet.noh
view: deps-view
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(FILE)
	@$(BUILD)/noh view $(FILE)

# What tests read of the demo.
TEST_PACKS := $(addprefix $(BUILD)/,mask.noh wig.noh mask_levels.noh demo/puppet_levels.noh demo/puppet.noh demo/puppet_falls.noh demo/arm.glb)
check: deps-check
	@[ "$(DEPS)" = 0 ] || sh tools/angle.sh $(BUILD)/angle
	@$(MAKE) --no-print-directory -j$(JOBS) WERROR="$(CHECK_WERROR)" all tests $(TEST_PACKS)
	@CC="$(CC)" NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" NOH_SAN="$(SAN)" sh tests/run.sh

# What the table in tests/README.md says of its tests.
mutants: deps-check
	@$(MAKE) --no-print-directory -j$(JOBS) $(TEST_PACKS)
	@NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" JOBS="$(JOBS)" sh tests/mutants.sh

# Under ThreadSanitizer.
threads: deps-fuzz
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/mask_levels.noh $(BUILD)/demo/puppet_levels.noh
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tests/tsan.sh

# What CI leaves out to be done in time (.ci/run): NOH_LONG=1 in every stage, five minutes for every fuzzer, and three
# stages more.
deps-long:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build check view fuzz lint long
check-long: deps-long
	@NOH_LONG=1 DEPS="$(DEPS)" FUZZ_SECONDS=300 AFL_SECONDS=300 .ci/run

# The same bits from every compiler, optimisation and processor that is here, and as in tests/golden/golden.txt.
golden: deps-cross
	@$(MAKE) --no-print-directory -j$(JOBS) amalgam $(BUILD)/mask_levels.noh $(BUILD)/demo/puppet_levels.noh $(BUILD)/demo/puppet.noh
	@NOH_BUILD="$(BUILD)" sh tests/golden.sh

golden-update:
	@$(MAKE) --no-print-directory -j$(JOBS) amalgam $(BUILD)/mask_levels.noh $(BUILD)/demo/puppet_levels.noh $(BUILD)/demo/puppet.noh
	@NOH_BUILD="$(BUILD)" sh tests/golden.sh update

# What characters take, to the byte, as in tests/golden/budgets.txt.
BUDGET_PACKS := $(BUILD)/mask.noh $(BUILD)/wig.noh $(BUILD)/demo/puppet.noh $(BUILD)/demo/puppet_levels.noh
budgets: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUDGET_PACKS)
	@NOH_BUILD="$(BUILD)" sh tests/budgets.sh
	@column -t -s '	' tests/golden/budgets.txt 2>/dev/null || cat tests/golden/budgets.txt

budgets-update:
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUDGET_PACKS)
	@NOH_BUILD="$(BUILD)" sh tests/budgets.sh update

cross: deps-cross
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tests/cross.sh

bench: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/mask.noh $(BUILD)/demo/puppet.glb $(BUILD)/lod_compare
	@NOH_ASSETS="$(ASSETS)" sh tools/bench.sh $(BUILD)
	@NOH_ASSETS="$(ASSETS)" sh tools/lod_compare/compare.sh $(BUILD)

# What noh build says to the files of the glTF validator's own tests.
check-validator: $(BUILD)/noh
	$(Q)NOH_BUILD=$(BUILD) sh tests/validator_files.sh $(DIR)

# Only the comparison of LOD levels.
bench-lod: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/lod_compare $(BUILD)/mask.glb
	@NOH_ASSETS="$(ASSETS)" sh tools/lod_compare/compare.sh $(BUILD)

# ---- the page ----

# One program for all packs: the memory that it runs in is made in the browser, for its pack (platform/web/package).
WEB_PACK    ?= $(BUILD)/page/mask.noh
WEB_WIRE    ?= --error-um 10# of `noh pack`; empty: nothing is rounded
WEB         := $(BUILD)/web/$(basename $(notdir $(WEB_PACK)))
WEB_FLAGS   := -std=c99 -Os -msimd128 $(WARN) $(FP) -Wno-sign-conversion $(INCLUDES) -Iplatform/web
WEB_STACK   := 65536
WEB_STATIC  := 1048576
WEB_LINK    := -msse2 -s STANDALONE_WASM=1 --no-entry -s IMPORTED_MEMORY=1 -s ALLOW_MEMORY_GROWTH=1 -s MAXIMUM_MEMORY=2147483648 -s MALLOC=none \
               -s INITIAL_MEMORY=$(WEB_STATIC) -s TOTAL_STACK=$(WEB_STACK) -s ERROR_ON_UNDEFINED_SYMBOLS=0
WEB_PACKAGE := $(patsubst platform/web/package/%,%,$(wildcard platform/web/package/*))
# A request takes as long as kilobytes do, so the page's scripts are one, and so are the modules that it needs at once.
WEB_SCRIPTS := $(addprefix platform/web/,page.js targets.js load.js light.js faces.js hair.js speech.js tabs.js)
WEB_MODULES := $(addprefix platform/web/package/,camera.js pixels.js gl.js program.js pointer.js speech.js character.js)
WEB_PAGE    := $(addprefix $(WEB)/,index.html page.js page.noh page.nohz $(addprefix package/,noh.wasm page.js $(filter %.js,$(WEB_PACKAGE))))
WEB_CONVERTER := $(addprefix $(WEB)/package/convert/,convert.js convert.wasm worker.js)
WEB_OBJECTS := $(patsubst $(CURDIR)/%,%,$(BUILD))/web-objects# one name for make, however BUILD is written

web: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_PACK)
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_PAGE)
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_CONVERTER) || echo 'The page has no converter: it shows packs alone.'
	@sh tools/web_sizes.sh $(WEB)

# Of the mask and of the puppet; or of one pack, if it is named.
WEB_PACKS   := $(if $(filter file,$(origin WEB_PACK)),$(BUILD)/page/mask.noh $(BUILD)/demo/puppet_levels.noh $(BUILD)/wig.noh $(BUILD)/demo/puppet_falls.noh $(BUILD)/demo/arm_transfer.noh,$(WEB_PACK))
web-check: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/tests/gl/picture_diff $(BUILD)/demo/arm.glb $(WEB_OBJECTS)/plan.js $(WEB_PACKS)
	@$(MAKE) --no-print-directory DEPS=0 npm
	@NOH_BUILD="$(BUILD)" sh tests/web.sh $(WEB_PACKS)

# HOST=all: also to phones and others in the same network.
PORT ?= 8000
web-serve: web
	@node tools/web_serve.js $(WEB) $(PORT) $(if $(filter all,$(HOST)),all)

# The page's frame beside three.js's.
WEB_BENCH ?= $(ASSETS)/hero/head.glb
web-bench: deps-web
	@[ -f "$(WEB_BENCH)" ] || { echo 'skipped: no $(WEB_BENCH) (ASSETS=DIR says where models are)'; exit 0; }; \
	mkdir -p $(BUILD)/web-bench && \
	$(MAKE) --no-print-directory $(BUILD)/noh $(BUILD)/tests/gl/picture_diff && \
	NOH_BUILD="$(BUILD)" sh tests/web_bench_pack.sh $(WEB_BENCH) $(BUILD)/web-bench/$(basename $(notdir $(WEB_BENCH))).noh && \
	$(MAKE) --no-print-directory DEPS=0 web WEB_WIRE= WEB_PACK=$(BUILD)/web-bench/$(basename $(notdir $(WEB_BENCH))).noh && \
	NOH_BUILD="$(BUILD)" sh tests/web_bench.sh "$(WEB_BENCH)"

# Pictures beside those of three.js's standard materials.
LOOKS ?= $(ASSETS)/hero/head_skin.glb $(ASSETS)/hero/body.glb $(BUILD)/mask.glb
look-compare: deps-web $(BUILD)/noh $(BUILD)/mask.glb
	@NOH_BUILD="$(BUILD)" sh tests/web_look.sh $(LOOKS)

$(WEB)/page.nohz: $(WEB_PACK) $(BUILD)/noh
	@mkdir -p $(@D)
	$(Q)$(BUILD)/noh pack $< -o $@ --quiet $(WEB_WIRE)
$(WEB)/page.noh: $(WEB)/page.nohz
	$(Q)$(BUILD)/noh strip $< -o $@ --from-level 0 --quiet
$(WEB)/page.js: $(WEB_SCRIPTS)
	@mkdir -p $(@D)
	@cat $^ >$@
$(WEB)/package/page.js: $(WEB_MODULES) tools/web_join.sh
	@mkdir -p $(@D)
	$(Q)sh tools/web_join.sh $@ 'Character addPointers addGaze isSoftware' $(WEB_MODULES)
$(WEB)/package/noh.wasm: $(WEB_OBJECTS)/noh.wasm
	@mkdir -p $(@D)
	@cp $< $@
$(WEB)/%: platform/web/%
	@mkdir -p $(@D)
	@cp $< $@

# The program, and the planner that the tests run under node.
WEB_C := $(filter-out %/plan.c,$(wildcard platform/web/*.c)) $(RUNTIME_C)
WEB_O := $(WEB_C:%.c=$(WEB_OBJECTS)/%.o) $(WEB_OBJECTS)/shaders.gen.o
WEB_PLAN_O := $(WEB_OBJECTS)/platform/web/plan.o $(WEB_OBJECTS)/platform/web/cast.o $(WEB_OBJECTS)/platform/file.o $(filter-out $(WEB_OBJECTS)/platform/%,$(WEB_O))
WEB_CC := NODE_PATH="$$NODE_PATH:/usr/share/nodejs" emcc # links; Debian's emscripten uses Debian's node modules
$(BUILD)/web-cc: tools/web_cc.sh
	@mkdir -p $(@D)
	$(Q)sh tools/web_cc.sh $@
$(WEB_OBJECTS)/%.o: %.c | $(BUILD)/web-cc
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc $(WEB_FLAGS) -MMD -MP -c $< -o $@
$(WEB_OBJECTS)/shaders.gen.o: $(BUILD)/gen/shaders.gen.c | $(BUILD)/web-cc
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc $(WEB_FLAGS) -MMD -MP -c $< -o $@
$(WEB_OBJECTS)/plan.js: $(WEB_PLAN_O)
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_FLAGS) $^ -s NODERAWFS=1 -s EXIT_RUNTIME=1 -s ALLOW_MEMORY_GROWTH=1 -o $@
-include $(WEB_O:.o=.d) $(WEB_PLAN_O:.o=.d)

$(WEB_OBJECTS)/noh.wasm: $(WEB_O)
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_FLAGS) $^ $(WEB_LINK) -o $@ 2>$@.log || { cat $@.log; exit 1; }
	$(Q)! grep 'undefined symbol' $@.log | grep -v 'symbol: \(gl[A-Z]\|enable\|extension\|feedback\|height\|lost\|string\|width\)'

# ---- the page's converter ----

# `noh build` and `noh pack` as WebAssembly, which a page loads when a model is dropped on it (tools/web_convert). Headers
# of its libraries come from Debian's packages; meshoptimizer, which has more than headers, from their sources. Draco and
# Assimp are left out: what needs them is refused.
WEB_CONVERT   := $(BUILD)/web-convert
WEB_CONVERT_O := $(patsubst %,$(WEB_CONVERT)/%.o,$(basename $(addprefix tools/web_convert/,main.c webp_none.c stb.c libraries.cpp) \
                 tools/noh/build/cmd_build.c tools/noh/pack/cmd_pack.c tools/noh/file/pack_file.c platform/file.c platform/file_write.c \
                 $(addprefix tools/noh/cli/,args.c json.c message.c report_stream.c) $(filter-out %/webp_file.c,$(CONVERT_C)) \
                 $(filter-out tools/convert/fbx/fbx_a% tools/convert/fbx/fbx_m% tools/convert/fbx/fbx_s%,$(CONVERT_CC)))) \
                 $(patsubst %,$(WEB_CONVERT)/meshoptimizer/src/%.o,allocator indexcodec overdrawoptimizer vcacheoptimizer vertexcodec vertexfilter)
WEB_CONVERT_FLAGS := -O2 -msimd128 $(FP) -isystem $(WEB_CONVERT)/include
WEB_CONVERT_LINK  := -fwasm-exceptions -s ALLOW_MEMORY_GROWTH=1 -s MAXIMUM_MEMORY=2GB -s STACK_OVERFLOW_CHECK=0 -s ENVIRONMENT=worker,node \
                     -s TOTAL_STACK=1MB -s MODULARIZE=1 -s EXPORT_NAME=nohConvert -s INVOKE_RUN=0 \
                     -s EXPORTED_RUNTIME_METHODS=FS,callMain -s INCOMING_MODULE_JS_API=stdout,stderr,locateFile,wasmMemory

# Headers that any processor can have, and nothing else of /usr/include.
$(WEB_CONVERT)/include/.made: tools/web_convert/meshoptimizer.sh
	@mkdir -p $(@D)
	$(Q)sh tools/web_convert/meshoptimizer.sh $(WEB_CONVERT)
	$(Q)ln -sfn /usr/include/nlohmann /usr/include/stb /usr/include/tiny_gltf.h $(abspath $(WEB_CONVERT)/meshoptimizer/src/meshoptimizer.h) $(@D)
	@touch $@
$(WEB_CONVERT)/%.o: %.c $(WEB_CONVERT)/include/.made | $(BUILD)/web-cc
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc -std=c99 $(WEB_CONVERT_FLAGS) $(INCLUDES) -MMD -MP -c $< -o $@
$(WEB_CONVERT)/tools/%.o: tools/%.cpp $(WEB_CONVERT)/include/.made | $(BUILD)/web-cc
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc -std=c++17 -fwasm-exceptions $(WEB_CONVERT_FLAGS) -O1 -isystem /usr/include/stb $(INCLUDES) -MMD -MP -c $< -o $@
$(WEB_CONVERT)/meshoptimizer/%.o: $(WEB_CONVERT)/include/.made | $(BUILD)/web-cc
	$(call say,EMCC,$@)
	$(Q)$(BUILD)/web-cc $(WEB_CONVERT_FLAGS) -U__SSE2__ -w -c $(@:.o=.cpp) -o $@
$(WEB_CONVERT)/convert.js: $(WEB_CONVERT_O) $(filter-out $(WEB_OBJECTS)/platform/%,$(WEB_O))
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_CONVERT_FLAGS) $^ $(WEB_CONVERT_LINK) -o $@
-include $(WEB_CONVERT_O:.o=.d)
$(WEB_CONVERT)/convert.wasm: $(WEB_CONVERT)/convert.js
$(WEB)/package/convert/worker.js: tools/web_convert/worker.js
	@mkdir -p $(@D)
	@cp $< $@
$(WEB)/package/convert/convert.%: $(WEB_CONVERT)/convert.%
	@mkdir -p $(@D)
	@cp $< $@

# ---- the page's crowd ----

# `noh crowd --place` as a page of its own (platform/web/festival), of files of the tool and of what `make demo-crowd` shows.
# Its memory does not grow: a thousand people fit.
WEB_FESTIVAL   := $(WEB)/festival
WEB_FESTIVAL_O := $(patsubst %.c,$(WEB_OBJECTS)/%.o,platform/web/festival/festival.c platform/web/context.c platform/file.c \
                  $(addprefix tools/noh/crowd/,place_scene.c place_life.c place_people.c place_file.c crowd_measure.c crowd_hair.c) \
                  tools/noh/draw/lighting.c tools/noh/file/pack_file.c tools/noh/cli/message.c) \
                  $(patsubst %,$(WEB_CONVERT)/tools/%.o,web_convert/webp_none web_convert/stb noh/file/light_file $(addprefix convert/base/,error nearest image_file input_file text_scan))
WEB_FESTIVAL_FILES := $(addprefix $(WEB_FESTIVAL)/,index.html festival.js people.nohz festival.nohz festival.place)

web-festival: web
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_FESTIVAL)/program.js $(WEB_FESTIVAL_FILES)
$(WEB_FESTIVAL)/program.js: $(WEB_FESTIVAL_O) $(filter-out $(WEB_OBJECTS)/platform/%,$(WEB_O))
	@mkdir -p $(@D)
	$(call say,EMCC,$@)
	$(Q)$(WEB_CC) $(WEB_FLAGS) -O1 $^ -msse2 --no-entry -s ALLOW_MEMORY_GROWTH=0 -s INITIAL_MEMORY=64MB -s TOTAL_STACK=1MB -s ENVIRONMENT=web \
	    -s MODULARIZE=1 -s EXPORT_NAME=nohFestival -s EXPORTED_RUNTIME_METHODS=UTF8ToString,FS -s FORCE_FILESYSTEM=1 \
	    -s INCOMING_MODULE_JS_API=instantiateWasm -s ERROR_ON_UNDEFINED_SYMBOLS=0 -o $@ 2>$(WEB_OBJECTS)/festival.log || { cat $(WEB_OBJECTS)/festival.log; exit 1; }
	$(Q)! grep 'undefined symbol' $(WEB_OBJECTS)/festival.log | grep -v 'symbol: \(gl[A-Z]\|enable\|extension\|feedback\|height\|lost\|string\|width\)'
# From the third level down: a camera that is 3 m away sees no finer one.
$(WEB_OBJECTS)/festival/people.noh: $(BUILD)/demo/puppet.glb $(PUPPET_MOVES) $(BUILD)/noh
	@mkdir -p $(@D)
	$(Q)$(BUILD)/noh build $< -o $@ --lod 8 --lod-from 2 --graph $(PUPPET_MOVES) --quiet
$(WEB_FESTIVAL)/people.nohz: $(WEB_OBJECTS)/festival/people.noh
	@mkdir -p $(@D)
	$(Q)$(BUILD)/noh pack $< -o $@ --error-um 10 --quiet
$(WEB_FESTIVAL)/festival.nohz: $(BUILD)/demo_assets $(BUILD)/noh
	@mkdir -p $(@D) $(WEB_OBJECTS)/festival
	$(Q)$(BUILD)/demo_assets --festival $(WEB_OBJECTS)/festival/festival
	$(Q)$(BUILD)/noh build $(WEB_OBJECTS)/festival/festival.obj -o $(WEB_OBJECTS)/festival/festival.noh --unit-cm 100 --quiet
	$(Q)$(BUILD)/noh pack $(WEB_OBJECTS)/festival/festival.noh -o $@ --error-um 10 --quiet
$(WEB_FESTIVAL)/festival.place: tools/demo_assets/festival/festival.place
	@mkdir -p $(@D)
	@cp $< $@
$(WEB_FESTIVAL)/%: platform/web/festival/%
	@mkdir -p $(@D)
	@cp $< $@

# ---- the package ----

# noh-character for npm: what platform/web/package has, the program, and the version of the library.
NPM := $(BUILD)/npm
npm: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB_CONVERT)/convert.wasm || echo 'The package has no converter: it shows packs alone.'
	@$(MAKE) --no-print-directory -j$(JOBS) $(NPM)/noh-character-$(VERSION).tgz
$(NPM)/noh-character-$(VERSION).tgz: $(addprefix platform/web/package/,$(WEB_PACKAGE)) $(WEB_OBJECTS)/noh.wasm LICENSE tools/npm.sh runtime/core/base/version.h \
    tools/web_convert/worker.js $(wildcard $(WEB_CONVERT)/convert.wasm)
	@VERSION=$(VERSION) sh tools/npm.sh $(NPM) platform/web/package $(WEB_OBJECTS)/noh.wasm LICENSE tools/web_convert/worker.js $(WEB_CONVERT)

# FUZZ_SECONDS=60: how long, both at once. Skips where clang or its runtime is not.
fuzz: deps-fuzz
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/tests/fuzz/corpus/.made $(BUILD)/gen/shaders.gen.c
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" FUZZ_SECONDS="$(FUZZ_SECONDS)" sh tests/fuzz.sh

tests: $(TESTS) $(EXAMPLES) $(if $(SAN),,$(AMALGAM_TESTS) $(BUILD)/noh_without) $(BUILD)/tests/gl/window $(BUILD)/tests/gl/picture_diff $(BUILD)/platform/template.o $(if $(SANITIZED),,$(BUILD)/lod_compare) \
       $(BUILD)/tests/fuzz/fuzz_import $(BUILD)/tests/fuzz/fuzz_pack $(BUILD)/tests/fuzz/fuzz_clip $(BUILD)/tests/fuzz/fuzz_wire $(BUILD)/tests/fuzz/corpus/.made

# The tests load packs, draw them and read results back as the tool does, and share what lies in tests/ and
# tests/support. Of the tool each takes what it calls, and the library has its asserts on.
TEST_SHARED_O := $(patsubst %.c,$(BUILD)/%.o,$(filter-out $(TEST_C),$(wildcard tests/*.c) $(call sources,tests/support,*.c)))
TEST_KERNELS := $(if $(filter x86_64%,$(MACHINE)),$(BUILD)/kernel/clip_sample_avx2.o)
TEST_LIBS := $(TEST_SHARED_O) $(BUILD)/tests/tool.a $(BUILD)/assert/libnoh.a

# One archive: a program links only what it calls, which is far quicker than all the objects.
$(BUILD)/tests/tool.a: $(filter-out %/main.o,$(TOOL_O)) $(CONVERT_O) $(PLATFORM_O) $(KERNELS) $(TEST_KERNELS)
	@mkdir -p $(@D)
	@rm -f $@
	$(call say,AR,$@)
	$(Q)$(AR) rcsD $@ $^

$(BUILD)/tests/%.o: INCLUDES += -Itests -Itests/support
# They are compiled in two thirds of the time so.
$(BUILD)/tests/%.o: OPT = -O1 -g1
$(BUILD)/tests/%: $(BUILD)/tests/%.o $(TEST_LIBS)
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $^ -o $@ -lcmocka $(TOOL_LIBS)

# The tests of bits with the library as plain C (tests/check_plain_c.sh, which makes that one).
$(BUILD)/plain/tests/%: $(BUILD)/tests/unit/%.o $(TEST_SHARED_O) $(BUILD)/tests/tool.a $(BUILD)/plain/libnoh.a
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $^ -o $@ -lcmocka $(TOOL_LIBS)

# The library's CPU tests, those that need neither C++ nor GL nor the tool, for another processor: tests/cross.sh
# calls this with CC, AR and CROSS=1. tests/cross/ stands in for the libraries that it has no package of.
CROSS       ?=
CROSS_SKIP  := face_files normal_map raw_turn mocap wire terrain gaze stage_gaze gltf_springs gltf_draco springs_pack stage_springs feet stage_feet obj_read ragdoll_rig ragdoll_pose transfer lips eye_split seam uv_targets wrinkles region_mask identity gltf_read gltf_left_out gltf_formula clip_import clip_bank pack_clip influences bvh_read events_read sources sources_kept \
               skin skin_list skin_oracle skin_pack bounds_pick pick source_errors simplify lod_chunks lod_certified lod_fit lod_lies levels pack \
               joint_order clip_errors lod_pack strip stage stage_between stage_day blob decal decal_grow stage_face stage_graph stage_part stage_ragdoll stage_springs walkers graph_text $(if $(findstring emcc,$(CC)),threads crowd_threads) \
               $(if $(SAN),,stage_threads)
CROSS_TESTS := $(patsubst tests/%.c,$(BUILD)/cross/%,$(filter-out tests/unit/tools/% $(addprefix %/test_,$(CROSS_SKIP:%=%.c)),$(call sources,tests/unit,test_*.c)))
CROSS_O     := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/cross/*.c) $(filter %/support.c %/pack_walk.c,$(wildcard tests/*.c tests/support/*.c)) \
                   platform/file.c platform/file_write.c $(CONVERT_C))
INCLUDES    += $(if $(CROSS),-Itests/cross -idirafter /usr/include)

cross-tests: $(CROSS_TESTS)
# build/cross/test_NAME is the test of that name, whichever folder it is in.
define cross_alias
$(BUILD)/cross/$(1): $(firstword $(filter %/$(1),$(CROSS_TESTS)))
	@cp $$< $$@
endef
$(foreach name,$(sort $(notdir $(CROSS_TESTS))),$(eval $(call cross_alias,$(name))))
$(BUILD)/cross/libtests.a: $(CROSS_O) $(BUILD)/libnoh.a
	@mkdir -p $(@D)
	@rm -f $@
	$(Q)$(AR) rcs $@ $(CROSS_O) $(RUNTIME_O)
$(BUILD)/cross/%: $(BUILD)/tests/%.o $(BUILD)/cross/libtests.a
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_LDFLAGS) $^ -o $@ -lm

$(BUILD)/tests/fuzz/corpus/.made: $(BUILD)/tests/fuzz/make_corpus
	@mkdir -p $(@D) $(BUILD)/tests/fuzz/clips $(BUILD)/tests/fuzz/wires
	@$< $(@D) $(BUILD)/tests/fuzz/clips $(BUILD)/tests/fuzz/wires >$(BUILD)/tests/fuzz/make_corpus.txt 2>&1 || { cat $(BUILD)/tests/fuzz/make_corpus.txt; exit 1; }
	@touch $@

# ---- installing, and what is made of the library ----

PREFIX     ?= /usr/local
BINDIR     ?= $(PREFIX)/bin
LIBDIR     ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
DATADIR    ?= $(PREFIX)/share
INSTALL    := BUILD="$(BUILD)" VERSION="$(VERSION)" CC="$(CC)" DESTDIR="$(DESTDIR)" PREFIX="$(PREFIX)" BINDIR="$(BINDIR)" \
              LIBDIR="$(LIBDIR)" INCLUDEDIR="$(INCLUDEDIR)" DATADIR="$(DATADIR)" sh tools/install/install.sh

install: all
	@$(INSTALL) all
# Needs no C++ compiler and none of the tools' libraries: make install-lib CC=... AR=... for another processor.
install-lib: lib
	@$(INSTALL) lib
uninstall:
	@$(INSTALL) remove

# make amalgam; tests links some tests with it instead of libnoh.a.
amalgam: $(AMALGAM)/noh.c
$(AMALGAM)/noh.c: $(BUILD)/amalgamate $(RUNTIME_C) $(call sources,runtime,*.h) $(BUILD)/gen/shaders.gen.c
	@mkdir -p $(@D)
	$(call say,AMALG,$@)
	$(Q)$(BUILD)/amalgamate -o $(@D) -I runtime -I $(BUILD)/gen $(RUNTIME_C:runtime/%=%) shaders.gen.c
$(BUILD)/amalgamate: tools/amalgam/amalgam.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(HOSTCC) -std=c99 -O2 $(WARN) $(SANFLAGS) $< -o $@
$(AMALGAM)/noh.o: $(AMALGAM)/noh.c
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) -c $< -o $@
$(AMALGAM)/%: $(BUILD)/tests/%.o $(filter-out %/libnoh.a,$(TEST_LIBS)) $(AMALGAM)/noh.o
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $^ -o $@ -lcmocka $(TOOL_LIBS)

# Small programs that show the library; they may use platform/ for a GL context.
examples: $(EXAMPLES)
$(BUILD)/examples/%: $(BUILD)/tools/examples/%.o $(BUILD)/libnoh.a
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_LDFLAGS) $^ -o $@ $(if $(shell grep -lsE '<EGL/|start.h' tools/examples/$*.c),-lEGL) \
	    $(if $(shell grep -ls measure.h tools/examples/$*.c),$(addprefix -Wl$(comma)--wrap=,malloc calloc realloc))

# Code and data of the library by processor, against the table of the last commit; make sizes-update writes that table.
sizes:
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tools/sizes.sh
sizes-update:
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tools/sizes.sh --update

deps-lint:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build view lint
lint: deps-lint
	@$(MAKE) --no-print-directory $(BUILD)/gen/shaders.gen.h $(BUILD)/gen/tool_shaders.gen.h
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tools/lint/lint.sh

deps-docs:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh docs
docs: deps-docs
	@NOH_BUILD="$(BUILD)" VERSION="$(VERSION)" sh tools/docs/docs.sh

clean:
	rm -rf $(BUILD)

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
