/* One round of MUMPS on a matrix in a file: mumps MATRIX SOLUTION. Compiled for real numbers, or with -DCOMPLEX.
 *
 * MATRIX: three 64-bit integers (equations n, entries, right-hand sides); 32-bit rows and columns from 1 of the lower triangle;
 * values; right-hand sides by columns. SOLUTION: that of the first. Times and figures to the standard output, a name and numbers
 * a line; the seconds of a phase are wall and CPU. */
#define _GNU_SOURCE
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#ifdef COMPLEX
#include <zmumps_c.h>
#define STRUCT ZMUMPS_STRUC_C
#define CALL zmumps_c
typedef ZMUMPS_COMPLEX number;
#else
#include <dmumps_c.h>
#define STRUCT DMUMPS_STRUC_C
#define CALL dmumps_c
typedef double number;
#endif

#define ICNTL(i) icntl[(i) - 1]
#define INFOG(i) infog[(i) - 1]
#define RINFOG(i) rinfog[(i) - 1]
enum { SOLVES = 3, USE_COMM_WORLD = -987654 };

static double wall(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static double cpu(void) {
    struct rusage r;
    getrusage(RUSAGE_SELF, &r);
    return r.ru_utime.tv_sec + r.ru_stime.tv_sec + 1e-6 * (r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

/* A line of /proc/self/status, in kB; 0 where there is none. */
static long status(const char *name) {
    char line[256];
    long value = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (!strncmp(line, name, strlen(name))) value = atol(line + strlen(name) + 1);
    if (file) fclose(file);
    return value;
}

static void *read_array(FILE *file, size_t size, size_t count) {
    void *array = malloc(size * count);
    if (!array || fread(array, size, count, file) != count) {
        fprintf(stderr, "the matrix cannot be read\n");
        exit(2);
    }
    return array;
}

static void run(STRUCT *id, int job, const char *name) {
    double w = wall(), c = cpu();
    id->job = job;
    CALL(id);
    if (name) printf("%s %.9f %.9f\n", name, wall() - w, cpu() - c);
    if (id->INFOG(1) < 0) {
        fprintf(stderr, "MUMPS's error %d, %d\n", id->INFOG(1), id->INFOG(2));
        exit(3);
    }
}

static void solve(STRUCT *id, const number *b, number *x, int columns, const char *name) {
    for (int k = 0; k < SOLVES; k++) {
        memcpy(x, b, sizeof(number) * (size_t)id->n * columns);
        id->rhs = x;
        id->nrhs = columns;
        id->lrhs = id->n;
        run(id, 3, name);
    }
}

int main(int argc, char **argv) {
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    if (!file) return 2;
    int64_t *head = read_array(file, sizeof *head, 3);
    STRUCT id;
    memset(&id, 0, sizeof id);
    MUMPS_INT *rows = read_array(file, sizeof *rows, head[1]), *columns = read_array(file, sizeof *columns, head[1]);
    number *values = read_array(file, sizeof *values, head[1]);
    number *b = read_array(file, sizeof *b, head[0] * head[2]);
    number *x = malloc(sizeof *x * head[0] * head[2]);
    fclose(file);
    id.comm_fortran = USE_COMM_WORLD;
    id.par = 1;
    id.sym = 2;
    run(&id, -1, NULL); /* forgets all pointers */
    id.n = head[0];
    id.nnz = head[1];
    id.irn = rows;
    id.jcn = columns;
    id.a = values;
    id.ICNTL(1) = id.ICNTL(2) = id.ICNTL(3) = -1;
    id.ICNTL(4) = 0;
    long before = status("VmRSS");
    run(&id, 1, "analysis");
    id.ICNTL(10) = 0; /* no refinement */
    run(&id, 2, "factor");
    solve(&id, b, x, head[2], "solve_8");
    solve(&id, b, x, 1, "solve_1");
    long entries = id.INFOG(29) < 0 ? -1000000L * id.INFOG(29) : id.INFOG(29);
    printf("peak %ld\nmemory %d\nentries %ld\nflops %.9g\n", status("VmHWM") - before, id.INFOG(22), entries,
           id.RINFOG(3));
    printf("negative %d\nordering %d\ndelayed %d\nperturbed %d\n", id.INFOG(12), id.INFOG(7), id.INFOG(13),
           id.INFOG(25));
    file = fopen(argv[2], "wb");
    if (!file || fwrite(x, sizeof *x, head[0], file) != (size_t)head[0] || fclose(file)) return 2;
    run(&id, -2, NULL);
    return 0;
}
