#include "cli/render/crew.h"

static const Crew *place;

void crew_join(const Crew *crew) { place = crew; }

const Crew *crew_place(void) { return place; }

bool crew_follows(void) { return place && place->rank > 0; }
