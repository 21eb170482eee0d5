/* Progress of a run on standard error, written by a thread of its own, so that the line is updated
   during long steps. `progress` documents each function. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { widest = 79, longest_label = 96 };

/* Seconds between two updates of the live line; without a terminal: seconds before the first line,
   factor by which intervals grow, longest interval; seconds before a time left is estimated. */
static const double live_interval = 0.2, first_line = 5, growth = 2, longest_interval = 600,
                    too_early = 1;

struct heartbeat {
  pthread_mutex_t lock;
  pthread_cond_t ended;
  pthread_t thread;
  int stop, live, shown, lines;
  /* The clock of waits and of times. */
  clockid_t clock;
  char name[longest_label], label[longest_label];
  /* Numbers of steps: done, done by an earlier run, failed, and all steps (0: unknown). */
  long done, given, failed, total;
  double began, origin, next, interval;
};

static double now(const struct heartbeat *self) {
  struct timespec t;
  clock_gettime(self->clock, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

/* A failure to write is ignored. */
static void put(const char *text, int length) {
  while (length > 0) {
    ssize_t written = write(STDERR_FILENO, text, length);
    if (written <= 0)
      return;
    text += written;
    length -= written;
  }
}

/* A time to about two digits, at most a hundred days. */
void snapin_duration(double seconds, char *text, int size) {
  long whole = seconds > 0 ? (seconds < 8.64e6 ? (long)(seconds + 0.5) : 8640000) : 0;
  if (whole < 100)
    snprintf(text, size, "%ld s", whole);
  else if (whole < 100 * 60)
    snprintf(text, size, "%ld min", (whole + 30) / 60);
  else
    snprintf(text, size, "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
}

static void show(struct heartbeat *self, double time) {
  char text[4 * longest_label], duration[32];
  int size = sizeof text, n = snprintf(text, size, "%s: %s", self->name, self->label);
  if (self->total > 0) {
    /* 100 % is left to the end of the run. */
    int percent = (int)(100.0 * self->done / self->total);
    n += snprintf(text + n, size - n, ", %d %%", percent < 99 ? percent : 99);
    if (self->failed > 0)
      n += snprintf(text + n, size - n, ", %ld failed", self->failed);
    if (self->done > self->given && self->done <= self->total && time - self->origin >= too_early) {
      double each = (time - self->origin) / (self->done - self->given);
      snapin_duration(each * (self->total - self->done), duration, sizeof duration);
      n += snprintf(text + n, size - n, each < 1 ? ", %.0f a second" : ", %.2g s each",
                    each < 1 ? 1 / each : each);
      n += snprintf(text + n, size - n, ", %s left", duration);
    }
  } else if (self->done > 0)
    n += snprintf(text + n, size - n, ", %ld states", self->done);
  snapin_duration(time - self->began, duration, sizeof duration);
  n += snprintf(text + n, size - n, ", %s so far", duration);
  if (self->live) {
    /* A line that wraps cannot be erased; narrower terminals are rare. */
    char line[2 * widest + 2];
    if (n > widest)
      text[n = widest] = 0;
    put(line, snprintf(line, sizeof line, "\r%-*s", self->shown > n ? self->shown : n, text));
    self->shown = n;
  } else {
    text[n] = '\n';
    put(text, n + 1);
    self->lines += 1;
    self->interval *= growth;
    if (self->interval > longest_interval)
      self->interval = longest_interval;
  }
  self->next = time + self->interval;
}

static void *beat(void *of) {
  struct heartbeat *self = of;
  pthread_mutex_lock(&self->lock);
  while (!self->stop) {
    double time = now(self);
    if (time >= self->next)
      show(self, time);
    struct timespec until = {.tv_sec = (time_t)self->next};
    until.tv_nsec = (long)(1e9 * (self->next - until.tv_sec));
    pthread_cond_timedwait(&self->ended, &self->lock, &until);
  }
  pthread_mutex_unlock(&self->lock);
  return NULL;
}

void *snapin_begin_progress(const char *name, long total, int live) {
  struct heartbeat *self = calloc(1, sizeof *self);
  pthread_condattr_t waits;
  pthread_attr_t small;
  if (!self)
    return NULL;
  snprintf(self->name, sizeof self->name, "%s", name);
  snprintf(self->label, sizeof self->label, "starting");
  self->total = total;
  self->live = live;
  self->interval = live ? live_interval : first_line;
  pthread_mutex_init(&self->lock, NULL);
  pthread_condattr_init(&waits);
  /* Some systems can wait by the time of day alone, which may be set meanwhile. */
  self->clock = CLOCK_MONOTONIC;
  if (pthread_condattr_setclock(&waits, CLOCK_MONOTONIC) != 0)
    self->clock = CLOCK_REALTIME;
  pthread_cond_init(&self->ended, &waits);
  self->began = self->origin = now(self);
  self->next = self->began + self->interval;
  /* A small stack, to leave address space to the calculation. */
  pthread_attr_init(&small);
  pthread_attr_setstacksize(&small, 1 << 16);
  if (pthread_create(&self->thread, &small, beat, self) == 0)
    return self;
  free(self);
  return NULL;
}

void snapin_progress(void *of, const char *label, int counted, int given, int failed) {
  struct heartbeat *self = of;
  pthread_mutex_lock(&self->lock);
  /* The label of a step of less than a second is too short to be read. */
  if (given < 0 && self->done - self->given > now(self) - self->origin) {
    pthread_mutex_unlock(&self->lock);
    return;
  }
  self->done += counted;
  self->failed += failed;
  if (given > 0)
    self->given = self->done;
  /* The time before the first counted step does not count in the time of a step. */
  if (given > 0 || (self->done == 0 && given == 0))
    self->origin = now(self);
  snprintf(self->label, sizeof self->label, "%s", label);
  pthread_mutex_unlock(&self->lock);
}

void snapin_end_progress(void *of) {
  struct heartbeat *self = of;
  char line[2 * longest_label], duration[32];
  pthread_mutex_lock(&self->lock);
  self->stop = 1;
  pthread_cond_signal(&self->ended);
  pthread_mutex_unlock(&self->lock);
  pthread_join(self->thread, NULL);
  if (self->shown > 0)
    put(line, snprintf(line, sizeof line, "\r%*s\r", self->shown, ""));
  if (self->lines > 0) {
    snapin_duration(now(self) - self->began, duration, sizeof duration);
    put(line, snprintf(line, sizeof line, "%s: ended after %s\n", self->name, duration));
  }
  free(self);
}
