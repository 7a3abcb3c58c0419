// A camera's driver for kernels that have no loopback device. Preloaded into a process, it answers the system calls on
// one path as uvcvideo answers those on /dev/video0; the path is a FIFO, and the test at its other end is the lens:
// each frame is a header {bytes, microseconds on the monotonic clock}, then the bytes. Without a lens the camera is
// unplugged. Built and preloaded by fake_v4l2.py.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define BUFFERS 4
#define BUFFER_BYTES (1 << 20)

static int camera = -1;
static char *memory[BUFFERS];
static int queued[BUFFERS], count, streaming;
static struct v4l2_pix_format format;
static struct { uint32_t id; int32_t value; } controls[16];

static uint32_t offered(void) {
  return getenv("FAKE_V4L2_YUYV") ? V4L2_PIX_FMT_YUYV : V4L2_PIX_FMT_MJPEG;
}

static int *control(uint32_t id) {
  for (int i = 0; i < 16; i++) {
    if (controls[i].id == id || controls[i].id == 0) {
      controls[i].id = id;
      return &controls[i].value;
    }
  }
  return NULL;
}

static int opened(const char *path, int flags, mode_t mode, const char *name) {
  const char *mine = getenv("FAKE_V4L2");
  int (*next)(const char *, int, ...) = dlsym(RTLD_NEXT, name);
  if (mine == NULL || strcmp(path, mine) != 0) return next(path, flags, mode);
  camera = next(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC, 0);
  return camera;
}

int open(const char *path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  return opened(path, flags, mode, "open");
}

int open64(const char *path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  mode_t mode = va_arg(rest, mode_t);
  va_end(rest);
  return opened(path, flags, mode, "open64");
}

static void *mapped(void *start, size_t bytes, int protection, int flags, int file, off_t offset, const char *name) {
  void *(*next)(void *, size_t, int, int, int, off_t) = dlsym(RTLD_NEXT, name);
  if (file < 0 || file != camera) return next(start, bytes, protection, flags, file, offset);
  int index = offset / BUFFER_BYTES;
  memory[index] = next(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return memory[index];
}

void *mmap(void *start, size_t bytes, int protection, int flags, int file, off_t offset) {
  return mapped(start, bytes, protection, flags, file, offset, "mmap");
}

void *mmap64(void *start, size_t bytes, int protection, int flags, int file, off_t offset) {
  return mapped(start, bytes, protection, flags, file, offset, "mmap64");
}

// All the bytes, or how many came before the lens was taken away.
static size_t whole(char *to, size_t bytes) {
  size_t got = 0;
  while (got < bytes) {
    ssize_t more = read(camera, to + got, bytes - got);
    if (more > 0) {
      got += more;
    } else if (more < 0 && errno == EAGAIN) {
      poll(&(struct pollfd){camera, POLLIN, 0}, 1, 100);
    } else {
      break;
    }
  }
  return got;
}

static int dequeued(struct v4l2_buffer *buffer) {
  struct { uint32_t bytes; uint32_t unused; uint64_t time_us; } frame;
  int index = 0;
  while (index < count && !queued[index]) index++;
  if (index == count) return errno = EAGAIN, -1;
  ssize_t got = read(camera, &frame, sizeof frame);
  if (got < 0) return -1;
  if (got != sizeof frame) return errno = ENODEV, -1;
  size_t held = frame.bytes < BUFFER_BYTES ? frame.bytes : BUFFER_BYTES;
  if (whole(memory[index], held) != held) return errno = ENODEV, -1;
  char spilled[4096];
  for (size_t left = frame.bytes - held; left > 0;) {
    size_t piece = whole(spilled, left < sizeof spilled ? left : sizeof spilled);
    if (piece == 0) return errno = ENODEV, -1;
    left -= piece;
  }
  queued[index] = 0;
  buffer->index = index;
  buffer->length = BUFFER_BYTES;
  buffer->bytesused = held;
  buffer->flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  buffer->timestamp.tv_sec = frame.time_us / 1000000;
  buffer->timestamp.tv_usec = frame.time_us % 1000000;
  return 0;
}

static int answered(unsigned long request, void *what) {
  struct v4l2_format *wanted = what;
  struct v4l2_buffer *buffer = what;
  struct v4l2_queryctrl *query = what;
  struct v4l2_control *set = what;
  switch (request) {
    case VIDIOC_QUERYCAP:
      ((struct v4l2_capability *)what)->capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
      return 0;
    case VIDIOC_S_FMT:
      format = wanted->fmt.pix;
      format.width = format.width < 640 ? 320 : 640;
      format.height = format.width * 3 / 4;
      format.pixelformat = offered();
      format.bytesperline = offered() == V4L2_PIX_FMT_YUYV ? 2 * format.width : 0;
      format.sizeimage = BUFFER_BYTES;
      wanted->fmt.pix = format;
      return 0;
    case VIDIOC_G_FMT:
      wanted->fmt.pix = format;
      return 0;
    case VIDIOC_S_PARM:
    case VIDIOC_G_PARM:
    case VIDIOC_S_INPUT:
      return 0;
    case VIDIOC_REQBUFS: {
      struct v4l2_requestbuffers *asked = what;
      count = asked->count < BUFFERS ? asked->count : BUFFERS;
      asked->count = count;
      memset(queued, 0, sizeof queued);
      return 0;
    }
    case VIDIOC_QUERYBUF:
      buffer->length = BUFFER_BYTES;
      buffer->m.offset = buffer->index * BUFFER_BYTES;
      return 0;
    case VIDIOC_QBUF:
      queued[buffer->index] = 1;
      return 0;
    case VIDIOC_DQBUF:
      return streaming ? dequeued(buffer) : (errno = EINVAL, -1);
    case VIDIOC_STREAMON:
      streaming = 1;
      return 0;
    case VIDIOC_STREAMOFF:
      streaming = 0;
      return 0;
    case VIDIOC_QUERYCTRL:
      query->minimum = 0;
      query->maximum = 10000;
      return 0;
    case VIDIOC_S_CTRL:
      // As uvcvideo: the exposure can not be set while the camera chooses it.
      if (set->id == V4L2_CID_EXPOSURE_ABSOLUTE && *control(V4L2_CID_EXPOSURE_AUTO) != V4L2_EXPOSURE_MANUAL)
        return errno = EINVAL, -1;
      *control(set->id) = set->value;
      if (getenv("FAKE_V4L2_LOG")) {
        FILE *log = fopen(getenv("FAKE_V4L2_LOG"), "a");
        fprintf(log, "%u %d\n", set->id, set->value);
        fclose(log);
      }
      return 0;
    case VIDIOC_G_CTRL:
      set->value = getenv("FAKE_V4L2_STUBBORN") ? 7 : *control(set->id);
      return 0;
    default:
      return errno = ENOTTY, -1;
  }
}

int ioctl(int file, unsigned long request, ...) {
  va_list rest;
  va_start(rest, request);
  void *what = va_arg(rest, void *);
  va_end(rest);
  if (file >= 0 && file == camera) return answered(request, what);
  int (*next)(int, unsigned long, ...) = dlsym(RTLD_NEXT, "ioctl");
  return next(file, request, what);
}

int close(int file) {
  int (*next)(int) = dlsym(RTLD_NEXT, "close");
  if (file >= 0 && file == camera) {
    camera = -1;
    streaming = count = 0;
  }
  return next(file);
}
