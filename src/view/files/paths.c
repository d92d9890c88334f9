#define _POSIX_C_SOURCE 200809L
#include "view/files/paths.h"

#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/path.h"

const char *path_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash && slash[1] ? slash + 1 : path;
}

PathKind path_kind(const char *path) {
    static const struct {
        const char *suffix;
        PathKind kind;
    } kinds[] = {{".gltf", PATH_SCENE},    {".glb", PATH_SCENE},     {".hdr", PATH_LIGHT},    {".exr", PATH_LIGHT},
                 {".json", PATH_MATERIAL}, {".png", PATH_PICTURE},   {".jpg", PATH_PICTURE},  {".jpeg", PATH_PICTURE},
                 {".webp", PATH_PICTURE},  {".tga", PATH_PICTURE},   {".tif", PATH_PICTURE},  {".tiff", PATH_PICTURE},
                 {".ktx2", PATH_PICTURE},  {".h", PATH_LOBE},        {".wif", PATH_DRAFT},    {".dtx", PATH_DRAFT},
                 {".u3m", PATH_MATERIAL},  {".u3ma", PATH_MATERIAL}, {".mtlx", PATH_MATERIAL}};
    struct stat s;
    if (path_builtin(path)) return PATH_SCENE;
    if (strncmp(path, "preset:", 7) == 0) return PATH_MATERIAL;
    if (stat(path, &s) == 0 && S_ISDIR(s.st_mode)) return PATH_FOLDER;
    const char *dot = strrchr(path_name(path), '.');
    for (size_t k = 0; dot && k < sizeof kinds / sizeof *kinds; k++)
        if (strcasecmp(dot, kinds[k].suffix) == 0) return kinds[k].kind;
    return PATH_UNKNOWN;
}

bool path_is_cubemap(const char *folder) {
    DIR *dir = opendir(folder);
    bool found = false;
    for (const struct dirent *d; dir && !found && (d = readdir(dir));)
        found = strncasecmp(d->d_name, "posx.", 5) == 0 || strncasecmp(d->d_name, "px.", 3) == 0;
    if (dir) closedir(dir);
    return found;
}

void path_stem(const char *path, char *stem, size_t size) {
    const char *builtin = path_builtin(path), *name = builtin ? builtin : path_name(path), *dot = strrchr(name, '.');
    snprintf(stem, size, "%.*s", dot && dot > name ? (int)(dot - name) : (int)strlen(name), name);
    for (char *p = stem; *p; p++)
        if (*p == '/' || iscntrl((unsigned char)*p)) *p = '-';
}

bool path_contains(const char *path, const char *word) {
    size_t length = strlen(word);
    for (const char *p = path_name(path); *p; p++)
        if (strncasecmp(p, word, length) == 0) return true;
    return false;
}

unsigned long long path_stamp(const char *path) {
    struct stat s;
    if (stat(path, &s) != 0) return 0;
    unsigned long long stamp =
        (unsigned long long)s.st_mtim.tv_sec * 1000000000ULL + (unsigned long long)s.st_mtim.tv_nsec;
    return (stamp * 31 + (unsigned long long)s.st_size) * 31 + (unsigned long long)s.st_ino + 1;
}
