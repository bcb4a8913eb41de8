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

# Contraction off: the CPU gives the same bits everywhere. No math errno: a square root is an instruction.
WARN     := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wvla -Werror
FP       := -ffp-contract=off -fno-math-errno
SANFLAGS := $(if $(SAN),-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
OPT      ?= -O2 -g
CFLAGS   += -std=c99 $(OPT) $(WARN) $(FP) $(SANFLAGS)
CXXFLAGS += -std=c++17 $(OPT) -Wall -Wextra $(FP) $(SANFLAGS)
LDFLAGS  += $(SANFLAGS)
INCLUDES := -Iruntime -Iplatform -Itools -Itools/noh -I$(BUILD)/gen
TOOL_LIBS := -ltinygltf -lmeshoptimizer -lstb -ldl -lm
# What runs is printed as a word and a file; V=1 prints the commands.
Q        := $(if $(V),,@)
say       = $(if $(V),,@printf '  %-6s %s\n' $(1) $(2))
MACHINE  := $(shell $(CC) -dumpmachine)

# ---- what there is ----

RUNTIME_C  := $(sort $(wildcard runtime/*/*.c))
# template.c is for reading; the tests compile it.
PLATFORM_C := $(filter-out platform/template.c,$(sort $(wildcard platform/*.c)))
CONVERT_C  := $(sort $(wildcard tools/convert/*.c tools/convert/*/*.c))
CONVERT_CC := $(sort $(wildcard tools/convert/*/*.cpp))
TOOL_C     := $(filter-out %/view_without.c,$(sort $(wildcard tools/noh/*.c tools/noh/bench/*.c)))
MASK_C     := $(sort $(wildcard tools/make_mask/*.c tools/make_puppet/*.c tools/make_arm/*.c))
STAGES     := vert geom frag
SHADERS    := $(sort $(foreach stage,$(STAGES),$(wildcard shaders_es/*.$(stage))))
TOOL_SHADERS := $(sort $(foreach stage,$(STAGES),$(wildcard tools/noh/shaders/*.$(stage) tools/noh/bench/*.$(stage))))
TEST_C     := $(sort $(wildcard tests/unit/test_*.c tests/memory/test_*.c tests/gl/test_*.c))

# `noh view` needs a window and panels; without their libraries the verb says which are missing.
VIEW_WITHOUT := $(strip $(if $(shell $(PKG) --exists glfw3 && echo y),,glfw3) $(if $(shell $(PKG) --exists imgui && echo y),,imgui))
VIEW_C     := $(sort $(wildcard tools/noh/view/*.c))
VIEW_CC    := $(sort $(wildcard tools/noh/view/*.cpp))
ifeq ($(VIEW_WITHOUT),)
VIEW_O     := $(VIEW_C:%.c=$(BUILD)/%.o) $(VIEW_CC:%.cpp=$(BUILD)/%.o)
VIEW_LIBS  := $(shell $(PKG) --libs glfw3 imgui)
else
VIEW_O     := $(BUILD)/tools/noh/view_without.o
endif

RUNTIME_O  := $(RUNTIME_C:%.c=$(BUILD)/%.o) $(BUILD)/gen/shaders.gen.o
PLATFORM_O := $(PLATFORM_C:%.c=$(BUILD)/%.o)
CONVERT_O  := $(CONVERT_C:%.c=$(BUILD)/%.o) $(CONVERT_CC:%.cpp=$(BUILD)/%.o)
TOOL_O     := $(TOOL_C:%.c=$(BUILD)/%.o) $(BUILD)/gen/tool_shaders.gen.o
MASK_O     := $(MASK_C:%.c=$(BUILD)/%.o)
TESTS      := $(TEST_C:tests/%.c=$(BUILD)/tests/%)

# The accumulation and skinning kernels built for other instruction sets, for `noh bench` and the tests.
KERNELS    := $(if $(filter x86_64%,$(MACHINE)),$(foreach set,sse2 avx2,$(BUILD)/kernel/morph_$(set).o $(BUILD)/kernel/skin_$(set).o))

.PHONY: FORCE install all demo demo-body view check bench bench-lod help clean deps-build deps-check deps-view deps-cross deps-web deps-fuzz cross cross-tests web web-check web-serve web-bench lib tests demo-run check-run fuzz sizes
.SECONDARY:
.DELETE_ON_ERROR:

all: $(BUILD)/noh $(BUILD)/libnoh.a

help:
	@echo 'make            build/noh and build/libnoh.a'
	@echo 'make demo       install what is missing, build, make the mask, convert it, render it'
	@echo 'make demo-body  the same with the puppet, a figure that walks, bows, looks round and dances'
	@echo 'make view       the puppet in a window: sliders, clips, memory and times (FILE=PACK|MODEL: another)'
	@echo 'make check      install what is missing, build and run the tests'
	@echo 'make bench      ratios against the named baselines (the mask, and hero/head.glb and clips where they are)'
	@echo 'make bench-lod  of them only levels of detail against meshoptimizer'"'"'s'
	@echo 'make fuzz       fuzz the pack reader and the clip decoder (FUZZ_SECONDS=60 each), needs clang'
	@echo 'make cross      the library and its CPU tests for aarch64, armv7 and wasm (qemu, node)'
	@echo 'make web        the page, WebGL 2 (WEB_PACK=PACK: for another pack); make web-serve, web-check, web-bench'
	@echo 'make sizes      code and data of the library, by file'
	@echo 'make install    PREFIX=/usr/local: noh, libnoh.a and the headers (compile with -IPREFIX/include/noh)'
	@echo 'make clean      remove $(BUILD)'
	@echo ''
	@echo 'V=1 prints the commands. DEPS=0 installs nothing. SAN=address,undefined builds with sanitizers (use another BUILD).'
	@echo 'ASSETS=DIR is where the tests look for models that are not ours to ship. NOH_TEST=NAME runs only those tests.'

# ---- the library ----

lib: $(BUILD)/libnoh.a

$(BUILD)/libnoh.a: $(RUNTIME_O)
	@rm -f $@
	$(call say,AR,$@)
	$(Q)$(AR) rcsD $@ $^

$(BUILD)/%.o: %.c | $(BUILD)/gen/shaders.gen.h $(BUILD)/gen/tool_shaders.gen.h
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(CFLAGS) $(INCLUDES) -MMD -MP -c $< -o $@

$(BUILD)/gen/%.o: $(BUILD)/gen/%.c
	$(call say,CC,$@)
	$(Q)$(CC) $(CFLAGS) $(INCLUDES) -MMD -MP -c $< -o $@

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
	$(Q)$(CXX) $(CXXFLAGS) -Iruntime -Itools -isystem /usr/include/stb -MMD -MP -c $< -o $@

$(BUILD)/kernel/morph_%.o: runtime/deform/morph.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(CFLAGS) $(INCLUDES) -m$* -DNOH_MORPH_ACCUMULATE=noh_morph_accumulate_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/clip_sample_%.o: runtime/anim/clip_sample.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(CFLAGS) $(INCLUDES) -m$* -Dnoh_clip_blend_frames=noh_clip_blend_frames_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/skin_%.o: runtime/deform/skin.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(CFLAGS) $(INCLUDES) -m$* -DNOH_SKIN_VERTICES=noh_skin_vertices_$* -MMD -MP -c $< -o $@

$(BUILD)/tools/noh/view/%.o: tools/noh/view/%.cpp | $(BUILD)/gen/shaders.gen.h
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(CXXFLAGS) $(INCLUDES) $(patsubst -I%,-isystem %,$(shell $(PKG) --cflags glfw3 imgui)) -MMD -MP -c $< -o $@

$(BUILD)/tools/noh/view_without.o: tools/noh/view_without.c $(BUILD)/gen/view_without
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(CFLAGS) $(INCLUDES) -DNOH_VIEW_WITHOUT='"$(subst $() , and ,$(VIEW_WITHOUT))"' -MMD -MP -c $< -o $@

# Changes when what is missing does: noh is then linked again.
$(BUILD)/gen/view_without: FORCE
	@mkdir -p $(@D)
	@echo '$(VIEW_WITHOUT)' | cmp -s - $@ || echo '$(VIEW_WITHOUT)' >$@
FORCE:

$(BUILD)/noh: $(TOOL_O) $(VIEW_O) $(CONVERT_O) $(PLATFORM_O) $(KERNELS) $(BUILD)/libnoh.a $(BUILD)/gen/view_without
	$(call say,CXX,$@)
	$(Q)$(CXX) $(LDFLAGS) $(filter %.o %.a,$^) -o $@ $(VIEW_LIBS) $(TOOL_LIBS)

$(BUILD)/make_mask: $(MASK_O)
	$(call say,CC,$@)
	$(Q)$(CC) $(LDFLAGS) $^ -o $@ -lm

# Makes runtime/anim/clip_tables.c out of raw clips; after a change of the clip format only.
$(BUILD)/clip_tables: $(BUILD)/tools/clip_tables/main.o $(CONVERT_O) $(PLATFORM_O) $(BUILD)/libnoh.a
	$(call say,CXX,$@)
	$(Q)$(CXX) $(LDFLAGS) $^ -o $@ $(TOOL_LIBS)

# Our levels of detail against meshoptimizer's; for `make bench`.
LOD_COMPARE_O := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard tools/lod_compare/*.c)))
$(BUILD)/lod_compare: $(LOD_COMPARE_O) $(CONVERT_O) $(PLATFORM_O) $(BUILD)/libnoh.a
	$(call say,CXX,$@)
	$(Q)$(CXX) $(LDFLAGS) $^ -o $@ $(TOOL_LIBS)

$(BUILD)/mask.glb: $(BUILD)/make_mask
	$(BUILD)/make_mask $@

$(BUILD)/demo/puppet.glb: $(BUILD)/make_mask
	@mkdir -p $(@D)
	$(BUILD)/make_mask --puppet $@

$(BUILD)/demo/arm.glb: $(BUILD)/make_mask
	@mkdir -p $(@D)
	$(BUILD)/make_mask --arm $@

$(BUILD)/mask.noh: $(BUILD)/mask.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --quiet
$(BUILD)/mask_levels.noh: $(BUILD)/mask.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --lod 4 --lod-fast --quiet
$(BUILD)/demo/puppet.noh: $(BUILD)/demo/puppet.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --quiet

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
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/demo/puppet.glb $(BUILD)/demo/arm.glb
	@NOH_ASSETS="$(ASSETS)" sh tools/demo_body.sh $(BUILD)

FILE    ?= $(BUILD)/demo/puppet.glb
view: deps-view
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(FILE)
	@$(BUILD)/noh view $(FILE)

check: deps-check
	@[ "$(DEPS)" = 0 ] || sh tools/angle.sh $(BUILD)/angle
	@$(MAKE) --no-print-directory -j$(JOBS) all tests $(BUILD)/mask.noh $(BUILD)/mask_levels.noh $(BUILD)/demo/puppet.glb $(BUILD)/demo/arm.glb
	@CC="$(CC)" NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" NOH_SAN="$(SAN)" sh tests/run.sh

cross: deps-cross
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tests/cross.sh

bench: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/mask.noh $(BUILD)/demo/puppet.glb $(BUILD)/lod_compare
	@NOH_ASSETS="$(ASSETS)" sh tools/bench.sh $(BUILD)
	@NOH_ASSETS="$(ASSETS)" sh tools/lod_compare/compare.sh $(BUILD)

# Only the comparison of levels of detail.
bench-lod: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/lod_compare $(BUILD)/mask.glb
	@NOH_ASSETS="$(ASSETS)" sh tools/lod_compare/compare.sh $(BUILD)

# ---- the page ----

# Built for one pack, in a folder of its own: WebAssembly memory cannot grow, and its size is the pack, what
# `noh budget` says at most of any path, the program's own static data, the stack and a heap for emscripten's strings.
WEB_PACK    ?= $(BUILD)/mask.noh
WEB         := $(BUILD)/web/$(basename $(notdir $(WEB_PACK)))
WEB_FLAGS   := -std=c99 -O2 -msimd128 -msse2 $(WARN) $(FP) -Wno-sign-conversion $(INCLUDES) -Iplatform/web
WEB_LINK    := -s MIN_WEBGL_VERSION=2 -s MAX_WEBGL_VERSION=2 -s ALLOW_MEMORY_GROWTH=0 -s ENVIRONMENT=web --no-entry \
               -s EXPORTED_RUNTIME_METHODS=UTF8ToString -s INCOMING_MODULE_JS_API=onRuntimeInitialized
WEB_STACK   := 65536
WEB_HEAP    := 65536
WEB_STATIC  := 262144
WEB_PAGE    := $(addprefix $(WEB)/,index.html page.js page.noh)

web: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(WEB_PACK)
	@$(MAKE) --no-print-directory -j$(JOBS) $(WEB)/noh.js $(WEB_PAGE)

# Of the mask and of the puppet; or of one pack, if it is named.
WEB_PACKS   := $(if $(filter file,$(origin WEB_PACK)),$(BUILD)/mask.noh $(BUILD)/demo/puppet.noh $(BUILD)/mask_levels.noh,$(WEB_PACK))
web-check: deps-web
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/tests/gl/picture_diff $(WEB_PACKS)
	@NOH_BUILD="$(BUILD)" sh tests/web.sh $(WEB_PACKS)

web-serve: web
	@echo 'http://localhost:8000/'
	@cd $(WEB) && python3 -m http.server 8000 --bind localhost

# The page's frame beside three.js's.
WEB_BENCH ?= $(ASSETS)/hero/head.glb
web-bench: deps-web
	@[ -f "$(WEB_BENCH)" ] || { echo 'skipped: no $(WEB_BENCH) (ASSETS=DIR says where models are)'; exit 0; }; \
	mkdir -p $(BUILD)/web-bench && \
	$(MAKE) --no-print-directory $(BUILD)/noh $(BUILD)/tests/gl/picture_diff && \
	$(BUILD)/noh build $(WEB_BENCH) -o $(BUILD)/web-bench/$(basename $(notdir $(WEB_BENCH))).noh --quiet && \
	$(MAKE) --no-print-directory DEPS=0 web WEB_PACK=$(BUILD)/web-bench/$(basename $(notdir $(WEB_BENCH))).noh && \
	NOH_BUILD="$(BUILD)" sh tests/web_bench.sh "$(WEB_BENCH)"

$(WEB)/page.noh: $(WEB_PACK)
	@mkdir -p $(@D)
	@cp $< $@
$(WEB)/%: platform/web/%
	@mkdir -p $(@D)
	@cp $< $@

WEB_C := $(wildcard platform/web/*.c) $(RUNTIME_C)
$(WEB)/noh.js: $(WEB_C) $(wildcard platform/web/*.h runtime/*/*.h) $(BUILD)/gen/shaders.gen.c $(WEB_PACK) $(BUILD)/noh
	@mkdir -p $(@D)
	@NOH_BUILD="$(BUILD)" PACK="$(WEB_PACK)" STACK=$(WEB_STACK) HEAP=$(WEB_HEAP) STATIC=$(WEB_STATIC) OUT=$@ \
	    FLAGS="$(WEB_FLAGS)" LINK="$(WEB_LINK)" sh tools/web.sh $(WEB_C) $(BUILD)/gen/shaders.gen.c

# FUZZ_SECONDS=60: how long, both at once. Skips where clang or its runtime is not.
fuzz: deps-fuzz
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/tests/fuzz/corpus/.made $(BUILD)/gen/shaders.gen.c
	@NOH_BUILD="$(BUILD)" FUZZ_SECONDS="$(FUZZ_SECONDS)" sh tests/fuzz.sh

tests: $(TESTS) $(BUILD)/tests/gl/window $(BUILD)/tests/gl/picture_diff $(BUILD)/platform/template.o \
       $(BUILD)/tests/fuzz/fuzz_pack $(BUILD)/tests/fuzz/fuzz_clip $(BUILD)/tests/fuzz/corpus/.made

# The tests load packs, draw them and read results back as the tool does, and share what lies in tests/ itself.
TEST_TOOL_O := $(addprefix $(BUILD)/tools/noh/,gpu.o readback.o readback_vertices.o message.o load.o load_draw.o scene.o scene_play.o scene_deform.o \
                   pack_file.o nearest.o args.o camera.o canvas.o crowd.o crowd_plan.o crowd_place.o crowd_frame.o crowd_draw.o) \
                   $(BUILD)/gen/tool_shaders.gen.o
TEST_SHARED_O := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/*.c))
TEST_KERNELS := $(if $(filter x86_64%,$(MACHINE)),$(BUILD)/kernel/clip_sample_avx2.o)
TEST_LIBS := $(TEST_SHARED_O) $(TEST_TOOL_O) $(CONVERT_O) $(PLATFORM_O) $(KERNELS) $(TEST_KERNELS) $(BUILD)/libnoh.a

$(BUILD)/tests/%.o: INCLUDES += -Itests
$(BUILD)/tests/%: $(BUILD)/tests/%.o $(TEST_LIBS)
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(LDFLAGS) $^ -o $@ -lcmocka $(TOOL_LIBS)

# The library's CPU tests, those that need neither C++ nor GL, for another processor: tests/cross.sh
# calls this with CC, AR and CROSS=1. tests/cross/ stands in for the libraries that it has no package of.
CROSS       ?=
CROSS_SKIP  := gltf_read gltf_formula embed motion_import motion_set pack_motion influences bvh_read events_read sources \
               skin skin_oracle skin_pack bounds_pick pick rows_deform puppet lod lod_pack lod_certified lod_lies levels pack joint_order \
               motion_errors detail_pack
CROSS_TESTS := $(filter-out $(CROSS_SKIP:%=$(BUILD)/cross/test_%),$(patsubst tests/unit/%.c,$(BUILD)/cross/%,$(wildcard tests/unit/test_*.c)))
CROSS_O     := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/cross/*.c) tests/support.c tests/pack_walk.c platform/file.c $(CONVERT_C))
INCLUDES    += $(if $(CROSS),-Itests/cross -idirafter /usr/include)

cross-tests: $(CROSS_TESTS)
$(BUILD)/cross/libtests.a: $(CROSS_O) $(BUILD)/libnoh.a
	@mkdir -p $(@D)
	@rm -f $@
	$(Q)$(AR) rcs $@ $(CROSS_O) $(RUNTIME_O)
$(BUILD)/cross/test_%: $(BUILD)/tests/unit/test_%.o $(BUILD)/cross/libtests.a
	$(call say,CC,$@)
	$(Q)$(CC) $(LDFLAGS) $^ -o $@ -lm

$(BUILD)/tests/fuzz/corpus/.made: $(BUILD)/tests/fuzz/make_corpus
	@mkdir -p $(@D) $(BUILD)/tests/fuzz/clips
	@$< $(@D) $(BUILD)/tests/fuzz/clips >$(BUILD)/tests/fuzz/make_corpus.txt 2>&1 || { cat $(BUILD)/tests/fuzz/make_corpus.txt; exit 1; }
	@touch $@

PREFIX  ?= /usr/local
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/lib
	install -m 755 $(BUILD)/noh $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(BUILD)/libnoh.a $(DESTDIR)$(PREFIX)/lib
	cd runtime && for h in noh.h $$(find . -name '*.h' ! -name '*_internal.h' ! -name '*_kernel.h' ! -name check.h ! -name lanes.h ! -name skin_blend.h); do \
	    install -D -m 644 $$h $(DESTDIR)$(PREFIX)/include/noh/$$h; done

sizes: $(BUILD)/libnoh.a
	@size -t $(BUILD)/libnoh.a

clean:
	rm -rf $(BUILD)

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
