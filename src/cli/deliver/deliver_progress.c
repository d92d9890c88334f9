#include "cli/deliver/delivery.h"

void delivery_part(Delivery *delivery, double low, double high) {
    delivery->low = low;
    delivery->high = high;
}

int delivery_heed(void *user, double fraction) {
    Delivery *delivery = user;
    return progress_heed(&delivery->progress, delivery->low + fraction * (delivery->high - delivery->low));
}
