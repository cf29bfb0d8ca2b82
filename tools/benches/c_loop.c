/* A loop that only sleeps, for `windup bench loop`: `c_loop PERIOD_NS TICKS` prints the lateness of
 * each wake-up, ns, one per line. It has the same priority and timer slack as our loop. */
#define _GNU_SOURCE
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <time.h>

static int64_t now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1000000000LL + t.tv_nsec;
}

int main(int count, char **words)
{
    if (count != 3)
        return 2;
    const int64_t period = atoll(words[1]), ticks = atoll(words[2]);
    int64_t *late = calloc(ticks, sizeof *late);
    if (late == NULL)
        return 1;
    struct sched_param precedence = {.sched_priority = 10};
    sched_setscheduler(0, SCHED_RR, &precedence); /* fails without permission, as in our loop */
    prctl(PR_SET_TIMERSLACK, 1);
    const int64_t start = now();
    for (int64_t k = 0; k < ticks; k++) {
        const int64_t due = start + (k + 1) * period;
        const struct timespec until = {due / 1000000000LL, due % 1000000000LL};
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
        late[k] = now() - due;
    }
    for (int64_t k = 0; k < ticks; k++)
        printf("%lld\n", (long long)late[k]);
    free(late);
    return 0;
}
