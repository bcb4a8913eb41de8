// view_light_panel.cpp: light and background, the camera, the floor, films.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#include <cstring>

namespace
{

void light_combo(view_app *a)
{
    const char *names[VIEW_LIGHT_COUNT + 1];
    int count = 0, at = 0;
    for (uint32_t i = 0; i < VIEW_LIGHT_COUNT; i++) {
        names[count++] = view_light_names[i];
    }
    const char *file = view_lights_file(&a->lights);
    if (file) {
        names[count++] = file;
        at = static_cast<int>(VIEW_LIGHT_COUNT);
    }
    for (uint32_t i = 0; i < VIEW_LIGHT_COUNT; i++) {
        at = std::strcmp(a->lights.name, view_light_names[i]) == 0 ? static_cast<int>(i) : at;
    }
    if (ui::choose("light", &at, names, count)) {
        view_light_choose(a, at < static_cast<int>(VIEW_LIGHT_COUNT) ? view_light_names[at] : "");
    }
}

void ending_buttons(view_app *a)
{
    static const char *const endings[] = { ".gif", ".mp4", ".png" };
    char *dot = std::strrchr(a->film.path, '.');
    for (const char *ending : endings) {
        const bool is = dot && std::strcmp(dot, ending) == 0;
        if (ending != endings[0]) {
            ImGui::SameLine();
        }
        if (ImGui::RadioButton(ending, is)) {
            const size_t length = dot ? static_cast<size_t>(dot - a->film.path) : std::strlen(a->film.path);
            if (length + 5 < sizeof a->film.path) {
                std::strcpy(a->film.path + length, ending);
            }
        }
        ui::note(ending);
        ui::hint(std::strcmp(ending, ".png") == 0 ? "numbered pictures: noh_0000.png and so on" : "made by ffmpeg");
    }
}

} // namespace

void light_section(view_app *a)
{
    static const char *const backgrounds[] = { "plain", "gradient", "light" };
    lighting *light = a->desc.light;
    if (a->model->show_bones || a->desc.view != NOH_VIEW_LIT || a->over.skin != VIEW_SKIN_OFF ||
        !ui::section("Light", true)) {
        return;
    }
    const ui::labelled width;
    light_combo(a);
    if (!light) {
        return;
    }
    float degrees = static_cast<float>(light->degrees);
    int background = static_cast<int>(light->background), tonemap = light->told.tonemap != NOH_TONEMAP_NONE;
    if (ui::slider("##turn", &degrees, -180.0f, 180.0f, "turned by %.0f degrees")) {
        lighting_turn(light, static_cast<double>(degrees), a->camera.facing);
    }
    if (ui::choose("background", &background, backgrounds, 3)) {
        light->background = static_cast<lighting_background>(background);
    }
    if (ui::checkbox("tone map", &tonemap)) {
        light->told.tonemap = tonemap ? NOH_TONEMAP_NEUTRAL : NOH_TONEMAP_NONE;
    }
}

void camera_section(view_app *a)
{
    if (!ui::section("Camera and floor", true)) {
        return;
    }
    ui::checkbox("follow", &a->camera.follow);
    ui::hint("the camera follows a figure that walks");
    ImGui::SameLine();
    ui::checkbox("turntable", &a->camera.turntable);
    ui::hint("T");
    ImGui::SameLine();
    ui::checkbox("floor", &a->ground.shown);
    ImGui::SameLine();
    if (ui::button("fit", -1.0f)) {
        view_frame_all(a);
    }
    ui::hint("frame all that plays, from the front; F");
    if (!a->model->file.pack.runs[NOH_CHUNK_SKELETON].count) {
        return;
    }
    const noh_place place = view_model_place(a->model);
    int walks = a->model->root_motion;
    if (ui::checkbox("root motion", &walks)) {
        view_walk(a, walks);
    }
    ui::hint("clips move the figure over the floor");
    ImGui::SameLine();
    if (ui::button("back to the start")) {
        view_walk_home(a);
    }
    ImGui::SameLine();
    if (ui::button("push", -1.0f)) {
        view_push(a);
    }
    ui::hint("push the chest: it falls, and gets up; P, or Alt-click on the figure");
    if (a->model->root_motion) {
        ImGui::TextDisabled("at %.3f %.3f", static_cast<double>(place.position[0]),
                            static_cast<double>(place.position[2]));
    }
}

void film_section(view_app *a)
{
    static const char *const whats[] = { "what plays, once", "one turn" };
    if (!ui::section("Film", false)) {
        return;
    }
    const ui::in within("film");
    if (a->film.job.is_on) {
        const float done = static_cast<float>(a->film.job.film.count) / static_cast<float>(a->film.job.frames);
        ImGui::ProgressBar(done, ImVec2(-70.0f, 0.0f));
        ImGui::SameLine();
        if (ui::button("stop", -1.0f)) {
            view_export_stop(&a->film.job);
        }
        return;
    }
    const ui::labelled width;
    ui::choose("of", &a->film.turns, whats, 2);
    ui::slider("##rate", &a->film.hz, VIEW_EXPORT_HZ_LEAST, VIEW_EXPORT_HZ_MOST, "%d pictures a second");
    ImGui::InputText("file", a->film.path, sizeof a->film.path);
    ui::note("file");
    ending_buttons(a);
    ImGui::SameLine();
    if (ui::button("save", -1.0f)) {
        view_export_begin(a);
    }
}
