/* Prints how much of the light a sheen reflects, from grazing to straight on: a first program with libweft.
 */
#include <stdio.h>

#include <weft/weft.h>

int main(void) {
    WeftError error;
    WeftLobe lobe;
    if (weft_lobe_init("charlie-neubelt", &lobe, &error) != WEFT_OK ||
        weft_lobe_set(&lobe, "alpha", "0.25", NULL, &error) != WEFT_OK) {
        fprintf(stderr, "albedo: %s\n", error.text);
        return error.result;
    }
    printf("weft %s, charlie-neubelt, alpha 0.25\n", weft_version());
    for (int k = 1; k <= 10; k++) {
        float e[3];
        weft_lobe_albedo(&lobe, (float)k / 10.0f, e);
        printf("cos %.1f  E %.5f\n", k / 10.0, (double)e[0]);
    }
    return 0;
}
