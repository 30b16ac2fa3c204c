// SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include "base/one_thread.h"

#ifdef KILN_TELL_THREAD_SANITIZER
extern "C" {  // sanitizer/tsan_interface.h
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace kiln {

namespace {

/// Says at `mark` that this thread's writes so far are seen by those that say acquire there.
void release([[maybe_unused]] char* mark) {
#ifdef KILN_TELL_THREAD_SANITIZER
  __tsan_release(mark);
#endif
}

void acquire([[maybe_unused]] char* mark) {
#ifdef KILN_TELL_THREAD_SANITIZER
  __tsan_acquire(mark);
#endif
}

/// Tells the thread sanitizer what it cannot see, because TBB is not built for it: a thread that works on a part has
/// seen what was written before the work was shared, and whoever waited for the parts sees what they wrote. Parts are
/// not said to see one another.
class SharedWork {
 public:
  SharedWork() { release(&begun_); }
  ~SharedWork() { acquire(&ended_); }
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

  /// Runs a part on the thread that it was given to.
  template <class Part>
  void run(const Part& part) {
    acquire(&begun_);
    const AtEnd at_end{&ended_};
    part();
  }

 private:
  struct AtEnd {
    char* mark;
    ~AtEnd() { release(mark); }
  };
  char begun_ = 0, ended_ = 0;
};

}  // namespace

void parallel_ranges(std::size_t begin, std::size_t end, std::size_t grain,
                     FunctionRef<void(std::size_t first, std::size_t last)> body) {
  SharedWork work;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain),
                    [&](const auto& range) { work.run([&] { body(range.begin(), range.end()); }); });
}

void parallel_invoke(FunctionRef<void()> one, FunctionRef<void()> other) {
  SharedWork work;
  tbb::parallel_invoke([&] { work.run(one); }, [&] { work.run(other); });
}

ThreadLimit::ThreadLimit(std::size_t threads)
    : control_(std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads)) {}

void on_one_thread(FunctionRef<void()> body) {
  SharedWork work;
  tbb::task_arena arena(1);
  arena.execute([&] { work.run(body); });
}

}  // namespace kiln
