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
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/mask.glb $(BUILD)/mask_levels.noh $(BUILD)/demo/nell.glb $(BUILD)/demo/flush.noh
	@sh tools/demo.sh $(BUILD)

demo-body: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUILD)/demo/puppet.glb $(BUILD)/demo/puppet_falls.noh $(BUILD)/demo/arm.glb
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
TEST_PACKS := $(addprefix $(BUILD)/,mask.noh $(if $(SANITIZED),,mask_far.noh) wig.noh mask_levels.noh demo/puppet_levels.noh demo/puppet.noh demo/puppet_falls.noh demo/roam.noh demo/coat.noh demo/arm.glb demo/nell.noh demo/flush.noh)
check-build: deps-check
	@[ "$(DEPS)" = 0 ] || sh tools/angle.sh $(BUILD)/angle
	@$(MAKE) --no-print-directory -j$(JOBS) WERROR="$(CHECK_WERROR)" $(if $(SANITIZED),$(BUILD)/noh,all) tests $(TEST_PACKS)
check: check-build
	@CC="$(CC)" NOH_BUILD="$(BUILD)" NOH_ASSETS="$(ASSETS)" NOH_SAN="$(SAN)" sh tests/run.sh

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

# The same bits from every compiler, optimisation and processor that is here, and as in tests/golden/golden.txt;
# golden-day: of 24 hours with three seeds, on four processors (NOH_DAY_S: other seconds).
golden: deps-cross
	@$(MAKE) --no-print-directory -j$(JOBS) amalgam $(BUILD)/mask_levels.noh $(BUILD)/demo/puppet_levels.noh $(BUILD)/demo/puppet.noh
	@NOH_BUILD="$(BUILD)" sh tests/golden.sh
golden-day: deps-cross
	@$(MAKE) --no-print-directory -j$(JOBS) amalgam $(BUILD)/demo/puppet.noh
	@NOH_BUILD="$(BUILD)" sh tests/golden.sh day

golden-update:
	@$(MAKE) --no-print-directory -j$(JOBS) amalgam $(BUILD)/mask_levels.noh $(BUILD)/demo/puppet_levels.noh $(BUILD)/demo/puppet.noh
	@NOH_BUILD="$(BUILD)" sh tests/golden.sh update

# What characters take, to the byte, as in tests/golden/budgets.txt.
BUDGET_PACKS := $(BUILD)/mask.noh $(BUILD)/mask_far.noh $(BUILD)/demo/nell.noh $(BUILD)/wig.noh $(BUILD)/demo/puppet.noh $(BUILD)/demo/puppet_levels.noh
budgets: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUDGET_PACKS)
	@NOH_BUILD="$(BUILD)" sh tests/budgets.sh
	@column -t -s '	' tests/golden/budgets.txt 2>/dev/null || cat tests/golden/budgets.txt

budgets-update:
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/noh $(BUDGET_PACKS)
	@NOH_BUILD="$(BUILD)" sh tests/budgets.sh update

# The shaders by the compilers of phones' GPUs, against tools/phones/table.txt. Minutes at first; what has not changed
# is kept in build/phones.
$(BUILD)/phones/texts.bin: tools/phones/texts.c $(BUILD)/libnoh.a
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) $(ALL_LDFLAGS) $^ -o $@

phones phones-update:
	@[ "$(DEPS)" = 0 ] || sh tools/deps.sh build long
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/phones/texts.bin
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tools/phones/phones.sh $(@:phones%=$(if $(filter %-update,$@),update))

cross: deps-cross
	@NOH_BUILD="$(BUILD)" JOBS="$(JOBS)" sh tests/cross.sh

bench: deps-build
	@$(MAKE) --no-print-directory -j$(JOBS) $(addprefix $(BUILD)/,noh demo_assets mask.noh demo/puppet.noh demo/puppet_levels.noh demo/roam.noh) $(BUILD)/lod_compare
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

tests: $(TESTS) $(BUILD)/tests/gl/picture_diff $(if $(SAN),,$(AMALGAM_TESTS) $(BUILD)/noh_without) \
       $(if $(SANITIZED),,$(EXAMPLES) $(BUILD)/tests/gl/window $(BUILD)/platform/template.o $(BUILD)/lod_compare) \
       $(BUILD)/tests/fuzz/fuzz_import $(BUILD)/tests/fuzz/fuzz_pack $(BUILD)/tests/fuzz/fuzz_clip $(BUILD)/tests/fuzz/fuzz_wire $(BUILD)/tests/fuzz/corpus/.made

# The tests load packs, draw them and read results back as the tool does, and share what lies in tests/support. Of it and
# of the tool each takes what it calls, and of support.c what runs before main; the library has its asserts on.
TEST_KERNELS := $(if $(filter x86_64%,$(MACHINE)),$(BUILD)/kernel/clip_sample_avx2.o)
TEST_OWN  := $(BUILD)/tests/support/support.o $(BUILD)/tests/support.a $(BUILD)/tests/tool.a
TEST_LIBS := $(TEST_OWN) $(BUILD)/assert/libnoh.a

# Archives: a program links only what it calls, which is far quicker than all the objects.
$(BUILD)/tests/support.a: $(patsubst %.c,$(BUILD)/%.o,$(call sources,tests/support,*.c))
$(BUILD)/tests/tool.a: $(filter-out %/main.o,$(TOOL_O)) $(CONVERT_O) $(PLATFORM_O) $(KERNELS) $(TEST_KERNELS)
$(BUILD)/tests/support.a $(BUILD)/tests/tool.a:
	@mkdir -p $(@D)
	@rm -f $@
	$(call say,AR,$@)
	$(Q)$(AR) rcsD $@ $^

$(BUILD)/tests/%.o: INCLUDES += -Itests -Itests/support
# They are compiled in two thirds of the time so. With sanitizers -O0 takes a third of the time of -O1, which is kept for
# the library and the converter, where tests spend their time.
$(BUILD)/tests/%.o: OPT = $(if $(SAN),-O0,-O1) -g1
$(BUILD)/tools/noh/%.o: OPT := $(if $(SAN),-O0 -g1,$(OPT))
$(BUILD)/tests/%: $(BUILD)/tests/%.o $(TEST_LIBS)
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $^ -o $@ -lcmocka $(TOOL_LIBS)

# The tests of bits with rooms of the library as plain C (tests/check_plain_c.sh, which makes that one).
$(BUILD)/plain/tests/%: $(BUILD)/tests/unit/%.o $(TEST_OWN) $(BUILD)/plain/libnoh.a $(BUILD)/libnoh.a
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $^ -o $@ -lcmocka $(TOOL_LIBS)

# The library's CPU tests, those that need neither C++ nor GL nor the tool, for another processor: tests/cross.sh
# calls this with CC, AR and CROSS=NAME. tests/cross/ replaces the libraries that it has no package of, and
# tests/cross/NAME for a system.
CROSS       ?=
CROSS_OWN   := $(wildcard tests/cross/$(CROSS)/*.[ch])
CROSS_C     := $(wildcard tests/cross/*.c) $(or $(filter %.c,$(if $(CROSS),$(CROSS_OWN))),platform/file.c platform/file_write.c) \
               $(addprefix tests/support/,support.c support_model.c pack_walk.c) $(filter-out %/webp_file.c,$(CONVERT_C))
CROSS_O     := $(CROSS_C:%.c=$(BUILD)/%.o) $(KERNELS) $(TEST_KERNELS)
ifneq ($(CROSS),)
INCLUDES    += $(addprefix -I,$(wildcard tests/cross/$(CROSS))) -Itests/cross -idirafter /usr/include
$(BUILD)/tests/%.o $(BUILD)/tools/%.o: INCLUDES += $(addprefix -include ,$(filter %.h,$(CROSS_OWN)))
# Half of the time of -O2: the tests there are of the library.
$(BUILD)/tools/convert/%.o: OPT := $(if $(NOH_LONG),$(OPT),-O1 -g1)
endif

cross-tests: $(if $(CROSS),$(patsubst tests/%.c,$(BUILD)/cross/%,$(shell sh tests/cross_tests.sh $(CROSS) $(CROSS_C))))
	@mkdir -p $(BUILD)/cross
	@printf '%s\n' $^ | sed '/^$$/d' >$(BUILD)/cross/programs
$(BUILD)/cross/libtests.a: $(CROSS_O) $(BUILD)/libnoh.a
	@mkdir -p $(@D)
	@rm -f $@
	$(Q)$(AR) rcs $@ $(CROSS_O) $(RUNTIME_O)
$(BUILD)/cross/%: $(BUILD)/tests/%.o $(BUILD)/cross/libtests.a
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_LDFLAGS) $^ -o $@ -lm
	@[ ! -f $@.exe ] || mv $@.exe $@

$(BUILD)/tests/fuzz/corpus/.made: $(BUILD)/tests/fuzz/make_corpus
	@mkdir -p $(@D) $(BUILD)/tests/fuzz/clips $(BUILD)/tests/fuzz/wires
	@$< $(@D) $(BUILD)/tests/fuzz/clips $(BUILD)/tests/fuzz/wires >$(BUILD)/tests/fuzz/make_corpus.txt 2>&1 || { cat $(BUILD)/tests/fuzz/make_corpus.txt; exit 1; }
	@touch $@
