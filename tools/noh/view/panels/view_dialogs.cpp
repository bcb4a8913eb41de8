// view_dialogs.cpp: what lies over the picture: how far a conversion is, the keys, whether to quit, what is compared.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#include <cstdio>
#include <cstring>

namespace
{

const int over_flags = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoSavedSettings;

// In the middle of the picture.
void begin_over(const view_app *a, const char *name, float width)
{
    float box[4];
    view_app_stage(a, box);
    ImGui::SetNextWindowPos(ImVec2(0.5f * (box[0] + box[2]), 0.5f * (box[1] + box[3])), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0.0f), ImVec2(width, 1e4f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16.0f, 14.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
    ImGui::Begin(name, nullptr, over_flags);
    ImGui::PopStyleVar(2);
}

void loading(view_app *a)
{
    const char *name = std::strrchr(a->files.load.path, '/');
    begin_over(a, "loading", 380.0f);
    ImGui::TextColored(amber, "converting %s", name ? name + 1 : a->files.load.path);
    ImGui::TextDisabled("%s", a->files.load.does);
    // The duration is not known: an animation shows that it runs, and the seconds are shown.
    const float at = static_cast<float>(view_load_seconds(&a->files.load)),
                share = at - 2.0f * static_cast<float>(static_cast<int>(at * 0.5f));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x - 80.0f, height = ImGui::GetFrameHeight();
    const float from = (share < 1.0f ? share : 2.0f - share) * width * 0.75f;
    ImDrawList *list = ImGui::GetWindowDrawList();
    char seconds[32];
    snprintf(seconds, sizeof seconds, "%.0f s", static_cast<double>(at));
    list->AddRectFilled(corner, ImVec2(corner.x + width, corner.y + height), ImGui::GetColorU32(ImGuiCol_FrameBg));
    list->AddRectFilled(ImVec2(corner.x + from, corner.y), ImVec2(corner.x + from + width * 0.25f, corner.y + height),
                        ImGui::GetColorU32(ImGuiCol_ButtonHovered));
    list->AddText(ImVec2(corner.x + 6.0f, corner.y + 3.0f), ImGui::GetColorU32(ImGuiCol_Text), seconds);
    ImGui::Dummy(ImVec2(width, height));
    ImGui::SameLine();
    if (ui::button("cancel", -1.0f)) {
        view_load_cancel(&a->files.load);
    }
    ImGui::End();
}

void quit(view_app *a)
{
    begin_over(a, "quit", 260.0f);
    ImGui::TextUnformatted("Quit?");
    ImGui::TextDisabled("Enter: yes, Esc: no");
    if (ui::button("quit", 110.0f)) {
        a->window.quits = 1;
    }
    ImGui::SameLine();
    if (ui::button("stay", 110.0f)) {
        a->window.quit_asked = 0;
    }
    ImGui::End();
}

void help(view_app *a)
{
    static const char *const keys[][2] = {
        { "drag", "turn about the figure" },
        { "right drag, wheel", "move, zoom" },
        { "F", "frame the clips that play, from the front" },
        { "T", "turntable" },
        { "click, Alt-click", "pick, push" },
        { "P", "push at the chest" },
        { "space", "play, pause" },
        { "W N B", "wireframe, normals, bones over the mesh" },
        { "L", "next level of detail" },
        { "[ ]", "turn the light" },
        { "Ctrl+Z, Ctrl+Shift+Z", "undo, redo" },
        { "Ctrl+C, Ctrl+V", "weights as text, to and from the clipboard" },
        { "I", "print the state" },
        { "Tab", "panels off and on" },
        { "F11, F12", "save the figure, the window" },
        { "Esc", "quit, after asking" },
    };
    begin_over(a, "keys", 500.0f);
    ImGui::TextColored(amber, "Keys and mouse");
    ImGui::Separator();
    for (const auto &key : keys) {
        ImGui::TextUnformatted(key[0]);
        ImGui::SameLine(170.0f);
        ImGui::TextDisabled("%s", key[1]);
    }
    ImGui::Separator();
    ImGui::TextDisabled("Files dropped on the window are shown; a file that");
    ImGui::TextDisabled("changes on disk is read again.");
    if (ui::button("close")) {
        a->window.show_help = 0;
    }
    ImGui::End();
}

void label(float x, const char *text)
{
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::CalcTextSize(text);
    list->AddRectFilled(ImVec2(x + 6.0f, 6.0f), ImVec2(x + 14.0f + size.x, 12.0f + size.y), IM_COL32(0, 0, 0, 150));
    list->AddText(ImVec2(x + 10.0f, 9.0f), IM_COL32_WHITE, text);
}

void columns(const view_app *a)
{
    const view_compare *c = &a->compare;
    char first[64], second[64], third[64];
    float box[4];
    view_app_stage(a, box);
    const float width = (box[2] - box[0]) / 3.0f;
    if (c->is.with == VIEW_COMPARE_PATH) {
        snprintf(first, sizeof first, "%s", noh_morph_path_name(a->model->morph_plan.path));
        snprintf(second, sizeof second, "%s", noh_morph_path_name(c->is.path));
    } else {
        view_lod_text(&a->lod, first, sizeof first);
        if (!a->lod.coarsest && !a->lod.fading) {
            snprintf(first, sizeof first, "full"); // as the label next to it
        }
        snprintf(second, sizeof second, c->is.level ? "level %u" : "full", c->is.level);
    }
    snprintf(third, sizeof third, "difference x %.0f", static_cast<double>(c->gain));
    label(box[0], first);
    label(box[0] + width, second);
    label(box[0] + 2.0f * width, third);
}

} // namespace

void dialogs(view_app *a)
{
    if (a->model && a->compare.is.with != VIEW_COMPARE_OFF) {
        columns(a);
    }
    if (a->files.load.state == VIEW_LOAD_RUNS) {
        loading(a);
    }
    if (a->window.show_help) {
        help(a);
    }
    if (a->window.quit_asked) {
        quit(a);
    }
}
