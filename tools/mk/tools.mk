# tools.mk: the converter, the program noh, the demo assets and their packs. Included by the Makefile.

# ---- the tools ----

# The C++ side is tinygltf's; its headers are not held to our warnings.
$(BUILD)/tools/convert/%.o: tools/convert/%.cpp
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -Iruntime -Itools -isystem /usr/include/stb -MMD -MP -c $< -o $@

# Written again only if the folder has other files than before.
include_all = printf '\#include "%s"\n' $(filter-out $(DRACO_CC),$(filter $(1)/%,$(CONVERT_CC)))
$(CONVERT_ROOMS:%=$(BUILD)/gen/%.cpp): $(BUILD)/gen/%.cpp: FORCE
	@mkdir -p $(@D)
	@$(call include_all,$*) | cmp -s - $@ || $(call include_all,$*) >$@
$(CONVERT_ROOMS:%=$(BUILD)/%.o): $(BUILD)/%.o: $(BUILD)/gen/%.cpp
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -I. -Iruntime -Itools -isystem /usr/include/stb -MMD -MP -c $< -o $@

# Tests and users spend their time in the converter's C, the compiler in this: -O1 takes two thirds of the time of -O2, and
# with sanitizers -O0 two thirds of the time of -O1.
$(CONVERT_CC_O): OPT := $(if $(SAN),-O0 -g1,$(patsubst -O2,-O1,$(OPT)))
$(BUILD)/tools/convert/gltf/gltf_draco.o: ALL_CXXFLAGS += $(if $(HAVE_DRACO),-DNOH_DRACO)
$(BUILD)/tools/convert/gltf/gltf_draco.o: $(BUILD)/gen/with_draco

# Changes when Draco comes or goes.
$(BUILD)/gen/with_draco: FORCE
	@mkdir -p $(@D)
	@echo '$(HAVE_DRACO)' | cmp -s - $@ || echo '$(HAVE_DRACO)' >$@

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
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_SIMD_SCALAR -DNOH_RAGDOLL_STEP=noh_ragdoll_step_dolls_scalar -MMD -MP -c $< -o $@

$(BUILD)/kernel/ragdoll_lanes_%.o: $(call kernel_c,ragdoll_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -m$* -DNOH_RAGDOLL_STEP=noh_ragdoll_step_dolls_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/spring_lanes_scalar.o: $(call kernel_c,spring_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_SIMD_SCALAR -DNOH_SPRING_STEP=noh_spring_step_scalar -DNOH_SPRING_ROTATIONS=noh_spring_rotations_scalar -MMD -MP -c $< -o $@

$(BUILD)/kernel/spring_lanes_%.o: $(call kernel_c,spring_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -m$* -DNOH_SPRING_STEP=noh_spring_step_$* -DNOH_SPRING_ROTATIONS=noh_spring_rotations_$* -MMD -MP -c $< -o $@

$(BUILD)/kernel/hair_lanes_scalar.o: $(call kernel_c,hair_lanes)
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_SIMD_SCALAR -DNOH_HAIR_STEP=noh_hair_step_scalar -DNOH_HAIR_POINTS=noh_hair_points_scalar -MMD -MP -c $< -o $@

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

# The same as on a machine that has only what it must: no Draco, no window. For the tests.
WITHOUT_O  := $(DRACO_CC:%.cpp=$(BUILD)/without/%.o) $(VIEW_NOT_C:%.c=$(BUILD)/without/%.o)
$(BUILD)/without/%.o: %.cpp
	@mkdir -p $(@D)
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_CXXFLAGS) -Iruntime -Itools -isystem /usr/include/stb -MMD -MP -c $< -o $@
$(BUILD)/without/%.o: %.c
	@mkdir -p $(@D)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_CFLAGS) $(INCLUDES) -DNOH_VIEW_WITHOUT='"glfw3 and imgui"' -MMD -MP -c $< -o $@
$(BUILD)/noh_without: $(TOOL_O) $(WITHOUT_O) $(filter-out %/gltf_draco.o,$(CONVERT_O)) $(PLATFORM_O) $(KERNELS) $(BUILD)/libnoh.a
	$(call say,CXX,$@)
	$(Q)$(CXX) $(ALL_LDFLAGS) $(QUICK_LD) $(filter %.o %.a,$^) -o $@ $(filter-out -ldraco,$(TOOL_LIBS))

# The converter as a library for other tools (tools/noh/build/noh_convert.h): one object, in which only that header's
# functions are global, so that it can be linked beside libnoh.a and any other code.
CONVERT_LIB_O := $(patsubst %,$(BUILD)/tools/noh/%.o,build/noh_convert build/cmd_build build/build_fail build/depfile \
                   cli/args cli/message cli/report_stream)
CONVERT_CALLS := noh_convert noh_convert_version
$(BUILD)/libnohconvert.a: $(CONVERT_LIB_O) $(CONVERT_O) $(PLATFORM_O) $(BUILD)/libnoh.a
	$(call say,LD,$@)
	$(Q)$(CXX) -r -nostdlib -Wl,--force-group-allocation,--gc-sections $(CONVERT_CALLS:%=-Wl,-u,%) $^ -o $(@:.a=.o)
	$(Q)$(OBJCOPY) $(CONVERT_CALLS:%=--keep-global-symbol=%) $(@:.a=.o)
	$(Q)rm -f $@ && $(AR) rcs $@ $(@:.a=.o)

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
# minutes; `tools/deps.sh ear` installs the synthesisers). To see how a synthesiser is read that was not heard, run
# build/train_ear with its name as the third argument.
TRAIN_EAR_O := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard tools/train_ear/*.c)))
$(BUILD)/train_ear: $(TRAIN_EAR_O) $(patsubst %,$(BUILD)/runtime/life/face/%.o,ear_cepstra ear_net phones)
	$(call say,CC,$@)
	$(Q)$(CC) $(ALL_LDFLAGS) $^ -o $@ -lespeak-ng -lm

$(BUILD)/tools/train_ear/learn.o: OPT := -O3 -march=native

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

$(BUILD)/demo/nell.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --nell $@
$(BUILD)/demo/nell.noh: $(BUILD)/demo/nell.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --plain --wrinkles face --quiet

$(BUILD)/demo/puppet.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --puppet $@

$(BUILD)/demo/coat.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --coat $@
COAT_SPRINGS := tools/demo_assets/puppet/coat.springs
$(BUILD)/demo/coat.noh: $(BUILD)/demo/coat.glb $(COAT_SPRINGS) $(BUILD)/demo/puppet_levels.noh $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --lod 3 --lod-fast --springs $(COAT_SPRINGS) --wear $(BUILD)/demo/puppet_levels.noh --quiet

$(BUILD)/demo/get_up.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --get-up $@

# For motion matching.
$(BUILD)/demo/roam.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --roam $@
ROAM_MATCH := tools/demo_assets/puppet/roam.match

$(BUILD)/demo/arm.glb: $(BUILD)/demo_assets
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --arm $@

$(BUILD)/mask.noh: $(BUILD)/mask.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --plain --wrinkles face --quiet
# The mask with colours that fade in with its targets.
FLUSH := tools/demo_assets/mask/flush.recipe
$(BUILD)/demo/flush.noh: $(BUILD)/mask.glb $(FLUSH) $(BUILD)/noh
	@mkdir -p $(@D)
	$(BUILD)/demo_assets --flush $(BUILD)/demo/flush.png
	$(BUILD)/noh build $< -o $@ --plain --wrinkles face --color-map $(BUILD)/demo/flush.png --recipe $(FLUSH) --only mesh --quiet
$(BUILD)/page/mask.noh: $(BUILD)/mask.glb $(BUILD)/noh
	@mkdir -p $(@D)
	$(BUILD)/noh build $< -o $@ --plain --wrinkles face --lod 4 --lod-fast --lod-color 1.2 --quiet
$(BUILD)/page/nell.noh: $(BUILD)/demo/nell.glb $(BUILD)/noh
	@mkdir -p $(@D)
	$(BUILD)/noh build $< -o $@ --plain --wrinkles face --lod 4 --lod-color 1.2 --quiet
# Packs of tests that count bytes have only what is asked for.
$(BUILD)/mask_levels.noh: $(BUILD)/mask.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --plain --lod 4 --lod-fast --quiet
# Far heads without targets.
$(BUILD)/mask_far.noh: $(BUILD)/mask.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --plain --lod 4 --lod-fast --lod-faces joints --lod-from 3 --quiet
MASK_HAIR := tools/demo_assets/mask/mask.hair
$(BUILD)/wig.noh: $(BUILD)/mask.glb $(MASK_HAIR) $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --plain --hair $(MASK_HAIR) --quiet
PUPPET_GRAPH := tools/demo_assets/puppet/puppet.graph
PUPPET_SPRINGS := tools/demo_assets/puppet/puppet.springs

# With what gets up from a fall.
$(BUILD)/demo/puppet_falls.noh: $(BUILD)/demo/puppet.glb $(BUILD)/demo/get_up.glb $(BUILD)/noh
	$(BUILD)/noh build $(filter %.glb,$^) -o $@ --plain --effort 1 --quiet

$(BUILD)/demo/arm_transfer.noh: $(BUILD)/demo/arm.glb $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --transfer 4 --quiet

PUPPET_MOVES := tools/demo_assets/puppet/moves.graph
# Under sanitizers these take minutes, and the other packs the same ways: they are copied from `make check`, where it has
# made them (NOH_LONG=1: never).
COPIED := demo/puppet.noh demo/puppet_levels.noh demo/roam.noh
ifneq ($(and $(SANITIZED),$(filter-out build,$(BUILD)),$(filter 3,$(words $(wildcard $(COPIED:%=build/%))))),)
$(COPIED:%=$(BUILD)/%): $(BUILD)/demo/%.noh: build/demo/%.noh
	@mkdir -p $(@D)
	@cp $< $@
else
$(BUILD)/demo/puppet.noh: $(BUILD)/demo/puppet.glb $(PUPPET_GRAPH) $(PUPPET_SPRINGS) $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --plain --graph $(PUPPET_GRAPH) --springs $(PUPPET_SPRINGS) --wrinkles auto --quiet
$(BUILD)/demo/puppet_levels.noh: $(BUILD)/demo/puppet.glb $(PUPPET_MOVES) $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --plain --lod 4 --lod-fast --graph $(PUPPET_MOVES) --quiet
$(BUILD)/demo/roam.noh: $(BUILD)/demo/roam.glb $(ROAM_MATCH) $(BUILD)/noh
	$(BUILD)/noh build $< -o $@ --match $(ROAM_MATCH) --effort 1 --quiet
endif

# Figures of shaders on phones, for `noh budget --gpu`.
$(BUILD)/tools/noh/budget/budget_phone.o: $(BUILD)/gen/phones.gen.h
$(BUILD)/gen/phones.gen.h: tools/phones/table.txt tools/phones/header.awk
	@mkdir -p $(@D)
	$(Q)awk -f tools/phones/header.awk tools/phones/table.txt >$@
