#define _GNU_SOURCE /* CPU_COUNT */
#include "mpi/deal.h"

#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/steady_clock.h"
#include "cli/console/interrupt.h"
#include "cli/render/picture_words.h"
#include "weft/weft.h"

enum { TAG_ASK = 1, TAG_WORK, TAG_SUMS, TAG_DONE };
enum { SHARES = 3 }; /* a block is this share of what is left for its process, at most */

static bool agreed;

static int rank_of(void) {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

static int size_of(void) {
    int size = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    return size;
}

/* Returns the number of threads of this process: those asked for, or its processors, to which mpirun may bind it. */
static int threads_of(const Gather *gather) {
    cpu_set_t set;
    if (gather->desc.threads) return gather->desc.threads;
    return sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0 ? CPU_COUNT(&set) : 1;
}

bool deal_agreed(void) { return agreed; }

/* Prints a failure of a process that does not lead. */
static void complain(const char *text) {
    char host[MPI_MAX_PROCESSOR_NAME];
    int length = 0;
    MPI_Get_processor_name(host, &length);
    text += strncmp(text, "weft: ", 6) == 0 ? 6 : 0;
    fprintf(stderr, "weft: rank %d on %.*s: %.*s\n", rank_of(), length, host, (int)strcspn(text, "\n"), text);
}

/* Returns the code of the first process whose code is not 0, which shows its complaint; else 0. */
static int codes_agree(int code, const char *complaint) {
    const int size = size_of();
    int *codes = calloc((size_t)size, sizeof *codes), first = 0;
    if (!codes) MPI_Abort(MPI_COMM_WORLD, WEFT_RESOURCES);
    MPI_Allgather(&code, 1, MPI_INT, codes, 1, MPI_INT, MPI_COMM_WORLD);
    while (codes && first < size - 1 && codes[first] == 0) first++;
    const int result = codes ? codes[first] : WEFT_RESOURCES;
    if (result != 0 && first > 0 && first == rank_of() && complaint) complain(complaint);
    free(codes);
    return result;
}

int deal_agree(int code, const char *complaint) {
    agreed = true;
    return codes_agree(code, complaint);
}

/* Checks that all processes are ready, and have the leader's picture. */
static WeftResult words_agree(const char *words, WeftError *error) {
    static const char *const none[] = {NULL};
    char leading[PART_WORDS], difference[WORDS_DIFFERENCE] = "", text[400];
    int code = deal_agree(0, NULL);
    if (code != 0)
        return failure(error, (WeftResult)code, "weft-mpi: not all processes are ready; nothing was rendered");
    snprintf(leading, sizeof leading, "%s", words);
    MPI_Bcast(leading, PART_WORDS, MPI_CHAR, 0, MPI_COMM_WORLD);
    const bool same = words_same(words, leading, none, difference);
    snprintf(text, sizeof text, "weft: has another picture than rank 0: %s", difference);
    code = codes_agree(same ? 0 : WEFT_USAGE, text);
    if (code == 0) return WEFT_OK;
    return failure(error, (WeftResult)code, "weft-mpi: the processes do not have one picture; nothing was rendered");
}

/* ---- a process that follows */

/* Returns the bytes of one tile: its head, then its numbers. */
static size_t tile_size(const WeftRender *render) {
    return WEFT_RENDER_TILE_HEAD +
           (size_t)(WEFT_RENDER_TILE * WEFT_RENDER_TILE) * (size_t)weft_render_tile_numbers(render);
}

/* Ends all processes: nothing else can be done where memory is short or a render fails in one of them. */
_Noreturn static void end_all(const char *text, int code) {
    complain(text);
    MPI_Abort(MPI_COMM_WORLD, code);
    exit(code);
}

/* Renders a block, and sends its sums. work: whether sums follow, then tiles. */
static void block_render(const Gather *gather, const int *work, int count, int spp) {
    WeftRender *render = gather->render;
    const size_t size = tile_size(render);
    float *sums = calloc((size_t)count * size, sizeof *sums);
    unsigned char *wanted = calloc((size_t)weft_render_tile_count(render), 1);
    if (!sums || !wanted) end_all("out of memory", WEFT_RESOURCES);
    if (work[0]) MPI_Recv(sums, (int)((size_t)count * size), MPI_FLOAT, 0, TAG_SUMS, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    for (int k = 0; k < count && sums && wanted; k++) {
        wanted[work[1 + k]] = 1;
        if (work[0] && weft_render_tile_set(render, work[1 + k], sums + (size_t)k * size, NULL) != WEFT_OK)
            end_all("has sums that are none", WEFT_RESOURCES);
    }
    if (weft_render_tiles_run(render, wanted, spp, NULL, NULL) != WEFT_OK)
        end_all("the render could not be finished", WEFT_RESOURCES);
    for (int k = 0; k < count && sums; k++) weft_render_tile(render, work[1 + k], sums + (size_t)k * size);
    MPI_Send(sums, (int)((size_t)count * size), MPI_FLOAT, 0, TAG_DONE, MPI_COMM_WORLD);
    free(wanted);
    free(sums);
}

/* Asks for blocks until there are none. */
static void follow(const Gather *gather, int spp) {
    const int tiles = weft_render_tile_count(gather->render);
    int *work = calloc((size_t)tiles + 1, sizeof *work), threads = threads_of(gather), got = 0;
    if (!work) end_all("out of memory", WEFT_RESOURCES);
    MPI_Send(&threads, 1, MPI_INT, 0, TAG_ASK, MPI_COMM_WORLD);
    for (;;) {
        MPI_Status status;
        MPI_Recv(work, tiles + 1, MPI_INT, 0, TAG_WORK, MPI_COMM_WORLD, &status);
        MPI_Get_count(&status, MPI_INT, &got);
        if (got < 2) break;
        block_render(gather, work, got - 1, spp);
    }
    free(work);
}

/* ---- the leader */

/* A block that a process has: some of the tiles of Deal.order. */
typedef struct DealtBlock {
    int first, count; /* count 0: none */
    int threads;      /* of the process; 0: it has not asked yet */
    bool gone;        /* this process was told that there is no more */
} DealtBlock;

/* TileSums that came while the leader rendered. */
typedef struct Arrived {
    struct Arrived *next;
    int first, count;
    float *sums; /* owned */
} Arrived;

typedef struct Deal {
    Gather *gather;
    int spp, size, tiles;
    size_t numbers;     /* of a tile */
    int *order;         /* tiles that lack samples */
    int count, dealt;   /* of order */
    int done;           /* tiles of order whose sums are in the render */
    float *earlier;     /* sums of order, if any of them has samples; NULL: none has */
    DealtBlock *blocks; /* by rank; 0: the leader's own */
    Arrived *arrived;
    int left; /* processes that have not been told that there is no more */
} Deal;

/* Lists the tiles that lack samples, and keeps the sums of those that have some. */
static bool deal_begin(Deal *deal) {
    WeftRender *render = deal->gather->render;
    deal->size = size_of();
    deal->tiles = weft_render_tile_count(render);
    deal->numbers = tile_size(render);
    deal->order = calloc((size_t)deal->tiles + 1, sizeof *deal->order);
    deal->blocks = calloc((size_t)deal->size, sizeof *deal->blocks);
    float *sums = calloc(deal->numbers, sizeof *sums);
    bool good = deal->order && deal->blocks && sums, some = false;
    for (int tile = 0; good && tile < deal->tiles; tile++) {
        weft_render_tile(render, tile, sums);
        if (sums[0] + sums[1] >= (float)deal->spp) continue;
        some |= sums[0] + sums[1] > 0.0f;
        deal->order[deal->count++] = tile;
    }
    free(sums);
    if (good && some) {
        deal->earlier = calloc((size_t)deal->count * deal->numbers, sizeof *deal->earlier);
        good = deal->earlier != NULL;
        for (int k = 0; good && k < deal->count; k++)
            weft_render_tile(render, deal->order[k], deal->earlier + (size_t)k * deal->numbers);
    }
    deal->left = deal->size - 1;
    return good;
}

static void deal_free(Deal *deal) {
    while (deal->arrived) {
        Arrived *first = deal->arrived;
        deal->arrived = first->next;
        free(first->sums);
        free(first);
    }
    free(deal->order);
    free(deal->blocks);
    free(deal->earlier);
}

/* Takes the next block for a process: its part of a share of what is left, but a tile for each of its threads. */
static DealtBlock block_next(Deal *deal, int threads) {
    const int rest = deal->count - deal->dealt;
    double all = 0.0;
    for (int k = 0; k < deal->size; k++) all += deal->blocks[k].threads ? deal->blocks[k].threads : threads;
    int count = (int)((double)rest * threads / (all * SHARES));
    if (count < threads) count = threads;
    if (count > rest) count = rest;
    const DealtBlock block = {.first = deal->dealt, .count = count, .threads = threads};
    deal->dealt += count;
    return block;
}

/* Sends a process its next block, or that there is none. */
static void block_send(Deal *deal, int rank) {
    DealtBlock *block = &deal->blocks[rank];
    *block = block_next(deal, block->threads);
    int *work = calloc((size_t)block->count + 1, sizeof *work);
    if (!work) end_all("out of memory", WEFT_RESOURCES);
    work[0] = deal->earlier != NULL;
    memcpy(work + 1, deal->order + block->first, (size_t)block->count * sizeof *work);
    MPI_Send(work, 1 + block->count, MPI_INT, rank, TAG_WORK, MPI_COMM_WORLD);
    if (block->count && deal->earlier)
        MPI_Send(deal->earlier + (size_t)block->first * deal->numbers, (int)((size_t)block->count * deal->numbers),
                 MPI_FLOAT, rank, TAG_SUMS, MPI_COMM_WORLD);
    block->gone = !block->count;
    deal->left -= block->gone;
    free(work);
}

/* Answers one message; returns false if there is none. */
static bool answer(Deal *deal) {
    MPI_Status status;
    int there = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (!there) return false;
    const int rank = status.MPI_SOURCE;
    DealtBlock *block = &deal->blocks[rank];
    if (status.MPI_TAG == TAG_ASK) {
        MPI_Recv(&block->threads, 1, MPI_INT, rank, TAG_ASK, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    } else {
        Arrived *arrived = calloc(1, sizeof *arrived);
        float *sums = calloc((size_t)block->count * deal->numbers, sizeof *sums);
        if (!arrived || !sums) end_all("out of memory", WEFT_RESOURCES);
        *arrived = (Arrived){.next = deal->arrived, .first = block->first, .count = block->count, .sums = sums};
        deal->arrived = arrived;
        MPI_Recv(sums, (int)((size_t)block->count * deal->numbers), MPI_FLOAT, rank, TAG_DONE, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        deal->done += block->count;
    }
    block_send(deal, rank);
    return true;
}

/* Copies what arrived into the render. */
static WeftResult arrived_take(Deal *deal, WeftError *error) {
    WeftResult result = WEFT_OK;
    while (deal->arrived && result == WEFT_OK) {
        Arrived *first = deal->arrived;
        for (int k = 0; k < first->count && result == WEFT_OK; k++)
            result = weft_render_tile_set(deal->gather->render, deal->order[first->first + k],
                                          first->sums + (size_t)k * deal->numbers, error);
        deal->arrived = first->next;
        free(first->sums);
        free(first);
    }
    return result;
}

/* Answers the others while the leader renders its own block: a WeftProgress whose user is a Deal. */
static int deal_heed(void *user, double fraction) {
    Deal *deal = user;
    while (answer(deal)) continue;
    const double own = fraction * deal->blocks[0].count;
    if (progress_heed(&deal->gather->progress, (deal->done + own) / deal->count)) return 1;
    deal->gather->due = clock_now() >= deal->gather->next;
    return deal->gather->due;
}

/* Renders the leader's block, writes checkpoints, and takes what arrived. */
static WeftResult own_render(Deal *deal, WeftError *error) {
    Gather *gather = deal->gather;
    DealtBlock *own = &deal->blocks[0];
    unsigned char *wanted = calloc((size_t)deal->tiles, 1);
    WeftResult result = wanted ? WEFT_OK : failure(error, WEFT_RESOURCES, "out of memory");
    for (int k = 0; k < own->count && wanted; k++) wanted[deal->order[own->first + k]] = 1;
    do {
        gather->due = false;
        if (result != WEFT_OK) break;
        result = weft_render_tiles_run(gather->render, wanted, deal->spp, deal_heed, deal);
        if (result != WEFT_OK && result != WEFT_INTERRUPTED)
            result = failure(error, result, "the render could not be finished");
        const WeftResult taken = arrived_take(deal, error);
        if (taken != WEFT_OK) result = taken;
        if (gather->due) result = gather_checkpoint(gather, error);
    } while (gather->due);
    if (result == WEFT_OK) deal->done += own->count;
    own->count = 0;
    free(wanted);
    return result;
}

/* Waits a moment for those that still render. */
static WeftResult rest_await(Deal *deal, WeftError *error) {
    const struct timespec moment = {.tv_nsec = 500000};
    if (!answer(deal)) nanosleep(&moment, NULL);
    WeftResult result = arrived_take(deal, error);
    if (progress_heed(&deal->gather->progress, (double)deal->done / deal->count)) return WEFT_INTERRUPTED;
    if (result == WEFT_OK && clock_now() >= deal->gather->next) result = gather_checkpoint(deal->gather, error);
    return result;
}

static WeftResult lead(Gather *gather, int spp, WeftError *error) {
    Deal deal = {.gather = gather, .spp = spp};
    WeftResult result = deal_begin(&deal) ? WEFT_OK : failure(error, WEFT_RESOURCES, "out of memory");
    while (result == WEFT_OK && (deal.done < deal.count || deal.left)) {
        deal.blocks[0] = block_next(&deal, threads_of(gather));
        result = deal.blocks[0].count ? own_render(&deal, error) : rest_await(&deal, error);
    }
    if (result == WEFT_OK) result = arrived_take(&deal, error);
    deal_free(&deal);
    return result;
}

/* Says what an interruption left, and ends all processes. */
static void interrupted_end(Gather *gather, WeftError *error) {
    const char *path = gather->job->request->checkpoint;
    progress_finish(&gather->progress);
    if (!path)
        report(0, "interrupted: nothing was written; --checkpoint FILE keeps what there is");
    else if (gather_checkpoint(gather, error) == WEFT_OK)
        report(0, "interrupted: %s has what there is, from which the same command goes on", path);
    else
        report_error(error);
    MPI_Abort(MPI_COMM_WORLD, WEFT_INTERRUPTED);
}

WeftResult deal_run(Gather *gather, const char *words, int spp, WeftError *error) {
    WeftResult result = words_agree(words, error);
    if (result != WEFT_OK) return result;
    if (rank_of() > 0)
        follow(gather, spp);
    else
        result = lead(gather, spp, error);
    if (result == WEFT_INTERRUPTED) interrupted_end(gather, error);
    if (result != WEFT_OK) {
        report_error(error);
        MPI_Abort(MPI_COMM_WORLD, (int)result);
    }
    const long long own = rank_of() > 0 ? weft_render_info(gather->render).rays : 0;
    MPI_Reduce(&own, &gather->rays, 1, MPI_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    return WEFT_OK;
}
