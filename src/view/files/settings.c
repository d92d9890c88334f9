#include "view/files/settings.h"

#include <stdio.h>
#include <string.h>

#include "view/files/json_file.h"

enum { SIZE_MOST = 1 << 20 };

Settings settings_default(void) { return (Settings){.width = 1280, .height = 720, .panel = 372.0f, .speed = 1.0f}; }

static bool place(char path[RECENT_PATH], bool make) {
    return json_file_place("XDG_CONFIG_HOME", ".config", "view.json", make, path, RECENT_PATH);
}

static void read_number(const json_t *root, const char *key, double low, double high, float *value) {
    const json_t *v = json_object_get(root, key);
    double x = json_number_value(v);
    if (json_is_number(v) && x >= low && x <= high) *value = (float)x;
}

void settings_read(Settings *self) {
    char path[RECENT_PATH];
    if (!place(path, false)) return;
    json_t *root = json_file_read(path, SIZE_MOST);
    float width = (float)self->width, height = (float)self->height;
    read_number(root, "width", 320.0, 16384.0, &width);
    read_number(root, "height", 240.0, 16384.0, &height);
    read_number(root, "panel", 240.0, 900.0, &self->panel);
    read_number(root, "speed", 0.01, 100.0, &self->speed);
    self->width = (int)width, self->height = (int)height;
    self->invert = json_is_true(json_object_get(root, "invert"));
    const char *folder = json_string_value(json_object_get(root, "folder"));
    if (folder) snprintf(self->folder, sizeof self->folder, "%s", folder);
    const json_t *recent = json_object_get(root, "recent");
    for (size_t k = 0; k < json_array_size(recent) && self->recent_count < RECENT_MOST; k++) {
        const char *text = json_string_value(json_array_get(recent, k));
        if (text && strlen(text) < RECENT_PATH) snprintf(self->recent[self->recent_count++], RECENT_PATH, "%s", text);
    }
    json_decref(root);
}

static json_t *as_json(const Settings *self) {
    json_t *recent = json_array();
    for (int k = 0; k < self->recent_count; k++) {
        json_t *path = json_string(self->recent[k]);
        if (path) json_array_append_new(recent, path);
    }
    json_t *folder = json_string(self->folder); /* NULL where it is not UTF-8 */
    return json_pack("{s:i,s:i,s:f,s:b,s:f,s:o,s:o}", "width", self->width, "height", self->height, "panel",
                     (double)self->panel, "invert", self->invert, "speed", (double)self->speed, "folder",
                     folder ? folder : json_string(""), "recent", recent);
}

bool settings_write(const Settings *self) {
    char path[RECENT_PATH];
    if (!place(path, true)) return false;
    json_t *root = as_json(self);
    bool good = root && json_file_write(path, root);
    json_decref(root);
    return good;
}

void settings_opened(Settings *self, const char *path) {
    int k = 0;
    if (strlen(path) >= RECENT_PATH) return;
    while (k < self->recent_count && strcmp(self->recent[k], path) != 0) k++;
    if (k == RECENT_MOST) k--;
    if (k == self->recent_count) self->recent_count++;
    memmove(self->recent[1], self->recent[0], (size_t)k * RECENT_PATH);
    snprintf(self->recent[0], RECENT_PATH, "%s", path);
}
