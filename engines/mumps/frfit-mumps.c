/* frfit-mumps: factors of symmetric matrices by MUMPS, on the ranks of an MPI job, for one client.
 *
 * frfit starts it (`mpirun -n K frfit-mumps`) and writes one line to its standard input:
 *     <host> <port> <token>
 * Rank 0 connects to that port, sends a greeting, and then obeys requests until the connection ends.
 * The protocol is in ../../crates/engine/src/protocol.rs; numbers are little endian, as on the machines
 * that this is built for. Whatever goes wrong with the connection or a rank ends the whole job:
 * the client sees the connection close, and has what the job wrote to standard error.
 *
 * Source: P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, SIAM J. Matrix Anal. Appl. 23 (2001) 15-41;
 * MUMPS 5.5 users' guide. */

#include <dmumps_c.h>
#include <errno.h>
#include <mpi.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>
#include <zmumps_c.h>

#define PROTOCOL 1
#define ICNTL(i) icntl[(i) - 1]
#define INFO(i) info[(i) - 1]
#define INFOG(i) infog[(i) - 1]
/* Bytes of one message between ranks: MPI counts in int. */
#define PIECE ((size_t)1 << 28)
/* A rank that waits sleeps between looks, up to so many nanoseconds: the client computes in the meantime. */
#define LONGEST_NAP 1000000

enum verb { SETTINGS = 1, PATTERN, FORECAST, FACTOR, SOLVE, FORGET_FACTOR, FORGET_PATTERN, USAGE, END };
enum scalar { REAL, COMPLEX };

/* A request, as it comes over the wire and goes to all ranks. */
struct request {
    uint32_t verb, scalar, pattern, factor;
    uint64_t size, entries;
};

/* The answer to every request but the last. */
struct outcome {
    int32_t code, detail; /* INFOG(1) and INFOG(2) of MUMPS */
    int64_t negative;     /* eigenvalues below zero; -1: not counted */
    int64_t bytes;        /* of a forecast: needed on the fullest machine; of an analysis: by this rank */
};

struct settings {
    int out_of_core;
    char folder[256];
};

struct pattern {
    uint32_t id;
    MUMPS_INT n;
    size_t entries, first, mine; /* of all ranks; this rank's part */
    MUMPS_INT *rows, *columns, *position;
    struct pattern *next;
};

/* A solver that has analysed a pattern; it holds a factor, or waits for the next. */
struct instance {
    uint32_t scalar, pattern, factor;
    int busy;
    struct outcome analysis;
    void *solver;
    struct instance *next;
};

static int rank, ranks, connection = -1;

static void die(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "frfit-mumps: rank %d: ", rank);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    fflush(stderr);
    MPI_Abort(MPI_COMM_WORLD, 1);
    exit(1);
}

static void *reserve(size_t bytes)
{
    void *memory = malloc(bytes ? bytes : 1);
    if (!memory)
        die("no memory for %zu bytes", bytes);
    return memory;
}

enum { real_inertia = 1, complex_inertia = 0 };

#define SOLVER DMUMPS_STRUC_C
#define CALL dmumps_c
#define NAME(x) real_##x
#include "factor.inc"
#undef SOLVER
#undef CALL
#undef NAME

#define SOLVER ZMUMPS_STRUC_C
#define CALL zmumps_c
#define NAME(x) complex_##x
#include "factor.inc"

/* ---- the connection: rank 0 alone ---- */

static void receive(void *into, size_t bytes)
{
    for (char *at = into; bytes > 0;) {
        ssize_t got = recv(connection, at, bytes, 0);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            die("the client is gone");
        at += got;
        bytes -= (size_t)got;
    }
}

static void answer(const void *from, size_t bytes)
{
    for (const char *at = from; bytes > 0;) {
        ssize_t put = send(connection, at, bytes, MSG_NOSIGNAL);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            die("the client is gone");
        at += put;
        bytes -= (size_t)put;
    }
}

static void call_client(void)
{
    char host[256], port[16], token[65];
    if (scanf("%255s %15s %64s", host, port, token) != 3)
        die("expected `<host> <port> <token>` on standard input; frfit starts this program itself");
    struct addrinfo hints = {.ai_socktype = SOCK_STREAM}, *all = NULL;
    int error = getaddrinfo(host, port, &hints, &all);
    if (error)
        die("%s: %s", host, gai_strerror(error));
    for (struct addrinfo *one = all; one && connection < 0; one = one->ai_next) {
        connection = socket(one->ai_family, one->ai_socktype, one->ai_protocol);
        if (connection >= 0 && connect(connection, one->ai_addr, one->ai_addrlen) != 0) {
            error = errno;
            close(connection);
            connection = -1;
        }
    }
    freeaddrinfo(all);
    if (connection < 0)
        die("no connection to %s port %s: %s", host, port, strerror(error));
    int on = 1;
    setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    setsockopt(connection, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    char greeting[96] = {0};
    memcpy(greeting, token, 64);
    uint32_t numbers[2] = {PROTOCOL, (uint32_t)ranks};
    memcpy(greeting + 64, numbers, sizeof numbers);
    snprintf(greeting + 72, 24, "%s", MUMPS_VERSION);
    answer(greeting, sizeof greeting);
}

/* ---- between ranks ---- */

static void nap(long *nanoseconds)
{
    struct timespec time = {0, *nanoseconds};
    nanosleep(&time, NULL);
    *nanoseconds = *nanoseconds * 2 < LONGEST_NAP ? *nanoseconds * 2 : LONGEST_NAP;
}

/* To all ranks, without the busy waiting of MPI_Bcast: between two requests minutes may pass. */
static void share(void *bytes, size_t count)
{
    MPI_Request pending;
    MPI_Ibcast(bytes, (int)count, MPI_BYTE, 0, MPI_COMM_WORLD, &pending);
    long time = 1000;
    for (int done = 0; !done;) {
        MPI_Test(&pending, &done, MPI_STATUS_IGNORE);
        if (!done)
            nap(&time);
    }
}

static size_t first_of(const struct pattern *pattern, int of)
{
    return (size_t)((unsigned __int128)pattern->entries * (unsigned)of / (unsigned)ranks);
}

/* From the client to each rank its own part of one array over all entries. */
static void *scatter(const struct pattern *pattern, size_t bytes_each)
{
    void *mine = reserve(pattern->mine * bytes_each);
    if (rank == 0)
        receive(mine, pattern->mine * bytes_each);
    for (int to = 1; to < ranks; to++) {
        size_t bytes = (first_of(pattern, to + 1) - first_of(pattern, to)) * bytes_each;
        char *piece = rank == 0 ? reserve(bytes < PIECE ? bytes : PIECE) : NULL;
        for (size_t done = 0; done < bytes; done += PIECE) {
            size_t now = bytes - done < PIECE ? bytes - done : PIECE;
            if (rank == 0) {
                receive(piece, now);
                MPI_Send(piece, (int)now, MPI_BYTE, to, 0, MPI_COMM_WORLD);
            } else if (rank == to) {
                MPI_Recv((char *)mine + done, (int)now, MPI_BYTE, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
            }
        }
        free(piece);
    }
    return mine;
}

/* ---- what there is ---- */

static struct settings settings;
static struct pattern *patterns;
static struct instance *instances;

static struct pattern *pattern_of(uint32_t id)
{
    struct pattern *pattern = patterns;
    while (pattern && pattern->id != id)
        pattern = pattern->next;
    if (!pattern)
        die("no pattern %u", id);
    return pattern;
}

static struct instance *holder_of(uint32_t factor)
{
    struct instance *instance = instances;
    while (instance && !(instance->busy && instance->factor == factor))
        instance = instance->next;
    return instance;
}

/* Its solver waits for the next factor; one that failed has none. */
static void forget_factor(uint32_t factor)
{
    struct instance *instance = holder_of(factor);
    if (instance)
        instance->busy = 0;
}

/* One that waits, or a new one. */
static struct instance *analysed(uint32_t id, uint32_t scalar)
{
    for (struct instance *one = instances; one; one = one->next)
        if (!one->busy && one->pattern == id && one->scalar == scalar)
            return one;
    struct instance *made = reserve(sizeof *made);
    *made = (struct instance){.scalar = scalar, .pattern = id, .next = instances};
    made->solver = (scalar == REAL ? real_analyse : complex_analyse)(pattern_of(id), &settings, &made->analysis);
    return instances = made;
}

static void end_instances_of(uint32_t pattern)
{
    for (struct instance **at = &instances; *at;) {
        struct instance *one = *at;
        if (one->pattern != pattern) {
            at = &one->next;
            continue;
        }
        *at = one->next;
        (one->scalar == REAL ? real_end : complex_end)(one->solver);
        free(one);
    }
}

/* ---- requests ---- */

static void take_pattern(const struct request *request)
{
    struct pattern *pattern = reserve(sizeof *pattern);
    *pattern = (struct pattern){.id = request->pattern, .n = (MUMPS_INT)request->size,
                                .entries = request->entries, .next = patterns};
    pattern->first = first_of(pattern, rank);
    pattern->mine = first_of(pattern, rank + 1) - pattern->first;
    if (rank == 0) {
        size_t bytes = request->size * sizeof(MUMPS_INT);
        pattern->position = reserve(bytes);
        receive(pattern->position, bytes);
    }
    pattern->rows = scatter(pattern, sizeof(MUMPS_INT));
    pattern->columns = scatter(pattern, sizeof(MUMPS_INT));
    patterns = pattern;
}

static void forget_pattern(uint32_t id)
{
    end_instances_of(id);
    for (struct pattern **at = &patterns; *at; at = &(*at)->next) {
        struct pattern *one = *at;
        if (one->id != id)
            continue;
        *at = one->next;
        free(one->rows);
        free(one->columns);
        free(one->position);
        free(one);
        return;
    }
}

static int64_t available_bytes(void)
{
    long long kilobytes = -1;
    char line[128];
    FILE *file = fopen("/proc/meminfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "MemAvailable: %lld kB", &kilobytes) == 1)
            break;
    if (file)
        fclose(file);
    return kilobytes < 0 ? -1 : kilobytes * 1000; /* KiB taken for kB: some room is left */
}

/* How much a factor takes on the machine where it takes the largest part of what is free there. */
static void forecast(const struct request *request, struct outcome *outcome, int64_t *available)
{
    struct instance *instance = analysed(request->pattern, request->scalar);
    *outcome = instance->analysis;
    MPI_Comm machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    long long needed[2] = {0, 0}, mine = instance->analysis.bytes;
    MPI_Allreduce(&mine, &needed[0], 1, MPI_LONG_LONG, MPI_SUM, machine);
    MPI_Comm_free(&machine);
    needed[1] = available_bytes();
    struct { double share; int rank; } fullest = {needed[1] > 0 ? (double)needed[0] / (double)needed[1] : 0.0, rank};
    MPI_Allreduce(MPI_IN_PLACE, &fullest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, MPI_COMM_WORLD);
    MPI_Bcast(needed, 2, MPI_LONG_LONG, fullest.rank, MPI_COMM_WORLD);
    outcome->bytes = needed[0];
    *available = needed[1];
}

static void factor(const struct request *request, struct outcome *outcome)
{
    const struct pattern *pattern = pattern_of(request->pattern);
    void *values = scatter(pattern, request->scalar == REAL ? sizeof(double) : 2 * sizeof(double));
    struct instance *instance = analysed(request->pattern, request->scalar);
    *outcome = instance->analysis;
    if (outcome->code >= 0) {
        (request->scalar == REAL ? real_factor : complex_factor)(instance->solver, values, outcome);
        instance->busy = 1;
        instance->factor = request->factor;
    }
    free(values);
}

static void solve(const struct request *request, struct outcome *outcome)
{
    struct instance *instance = holder_of(request->factor);
    if (!instance)
        die("no factor %u", request->factor);
    int complex = instance->scalar == COMPLEX;
    size_t bytes = (size_t)pattern_of(instance->pattern)->n * request->size * (complex ? 16 : 8);
    void *block = NULL;
    if (rank == 0) {
        block = reserve(bytes);
        receive(block, bytes);
    }
    (complex ? complex_solve : real_solve)(instance->solver, block, (int)request->size, outcome);
    if (rank == 0) {
        answer(outcome, sizeof *outcome);
        if (outcome->code >= 0)
            answer(block, bytes);
        free(block);
    }
}

/* Peak memory and time of each rank. */
static void usage(void)
{
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    double mine[2] = {1024.0 * (double)used.ru_maxrss, 0.0};
    mine[1] = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
              1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    double *all = reserve((size_t)ranks * sizeof mine);
    MPI_Gather(mine, 2, MPI_DOUBLE, all, 2, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    if (rank == 0)
        answer(all, (size_t)ranks * sizeof mine);
    free(all);
}

static int obey(void)
{
    struct request request;
    struct outcome outcome = {0, 0, -1, 0};
    int64_t available = -1;
    if (rank == 0)
        receive(&request, sizeof request);
    share(&request, sizeof request);
    switch (request.verb) {
    case SETTINGS:
        if (rank == 0)
            receive(settings.folder, sizeof settings.folder);
        share(settings.folder, sizeof settings.folder);
        settings.folder[sizeof settings.folder - 1] = 0;
        settings.out_of_core = settings.folder[0] != 0;
        break;
    case PATTERN:
        take_pattern(&request);
        break;
    case FORECAST:
        forecast(&request, &outcome, &available);
        break;
    case FACTOR:
        factor(&request, &outcome);
        break;
    case SOLVE:
        solve(&request, &outcome);
        return 1;
    case FORGET_FACTOR:
        forget_factor(request.factor);
        break;
    case FORGET_PATTERN:
        forget_pattern(request.pattern);
        break;
    case USAGE:
        usage();
        return 1;
    case END:
        return 0;
    default:
        die("a request of kind %u is unknown", request.verb);
    }
    if (rank == 0) {
        answer(&outcome, sizeof outcome);
        if (request.verb == FORECAST)
            answer(&available, sizeof available);
    }
    return 1;
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (rank == 0)
        call_client();
    while (obey())
        ;
    while (patterns)
        forget_pattern(patterns->id);
    MPI_Finalize();
    return 0;
}
