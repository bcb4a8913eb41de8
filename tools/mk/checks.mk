# checks.mk: demos, tests, benchmarks, other processors. Included by the Makefile.

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
CROSS_SKIP  := face_files skin_mirror crowd_round stage_bounds stage_far stage_stop normal_map raw_turn mocap wire terrain gaze stage_gaze gltf_springs gltf_draco springs_pack stage_springs feet stage_feet obj_read ragdoll_rig ragdoll_pose transfer lips eye_split seam uv_targets wrinkles region_mask identity gltf_read gltf_left_out gltf_formula clip_import clip_bank pack_clip influences bvh_read events_read sources sources_kept \
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
