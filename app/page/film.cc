#include "app/page/film.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/page/strip.h"
#include "app/recording/checked_file.h"
#include "app/session/motion_film.h"

extern char** environ;  // NOLINT: POSIX's

namespace pregrasp {
namespace {

constexpr int kFramesPerSecond = 30, kGifEvery = 3;

// ffmpeg with the pictures' bytes as its input. SIGPIPE is ignored by the program.
class Encoder {
 public:
  explicit Encoder(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe(ends) != 0) ThrowErrno("ffmpeg", "a pipe to it");
    input_ = ends[1];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) {
      words.push_back(const_cast<char*>(argument.c_str()));
    }
    words.push_back(nullptr);
    const int error = posix_spawnp(&process_, "ffmpeg", &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    if (error != 0) {
      close(std::exchange(input_, -1));
      process_ = -1;
      throw InputError("--out", "", "the program ffmpeg, which makes films (apt install ffmpeg)",
                       std::strerror(error));
    }
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() {
    if (input_ >= 0) close(input_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
  }

  // False where ffmpeg takes no more: Finish says why it ended.
  bool Write(const std::vector<std::uint8_t>& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t count = write(input_, bytes.data() + done, bytes.size() - done);
      if (count > 0) {
        done += static_cast<std::size_t>(count);
      } else if (errno != EINTR) {
        return false;
      }
    }
    return true;
  }

  // Whether it ended well.
  bool Finish() {
    close(std::exchange(input_, -1));
    int status = 0;
    while (waitpid(std::exchange(process_, -1), &status, 0) < 0) {
      if (errno != EINTR) return false;
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  int input_ = -1;
  pid_t process_ = -1;
};

std::vector<std::string> EncoderArguments(const std::filesystem::path& file,
                                          const PictureConfig& config) {
  const std::string kind = file.extension().string();
  const int per_second = kind == ".gif" ? kFramesPerSecond / kGifEvery : kFramesPerSecond;
  std::vector<std::string> arguments = {"ffmpeg",
                                        "-v",
                                        "error",
                                        "-nostdin",
                                        "-y",
                                        "-f",
                                        "rawvideo",
                                        "-pix_fmt",
                                        "rgb24",
                                        "-video_size",
                                        fmt::format("{}x{}", config.width, config.height),
                                        "-framerate",
                                        std::to_string(per_second),
                                        "-i",
                                        "-"};
  const auto add = [&](std::initializer_list<const char*> more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
  };
  if (kind == ".gif") {
    add({"-vf", "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=bayer"});
  } else if (kind == ".webm") {
    add({"-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used", "6", "-crf", "30", "-b:v", "0",
         "-pix_fmt", "yuv420p"});
  } else {
    add({"-c:v", "libx264", "-preset", "veryfast", "-crf", "20", "-pix_fmt", "yuv420p", "-movflags",
         "+faststart"});
  }
  add({"-threads", "1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1"});
  arguments.push_back(file.string());
  return arguments;
}

}  // namespace

bool IsFilmFile(const std::filesystem::path& file) {
  const std::string kind = file.extension().string();
  return kind == ".mp4" || kind == ".webm" || kind == ".gif";
}

void WriteFilm(const LoadedRun& run, const Shot& shot, const std::optional<Vector3>& view,
               const std::filesystem::path& file, const std::function<void(int, int)>& progress) {
  const std::vector<FilmFrame> film = RequireFilm(run);
  Shot one = shot;
  one.config.width += one.config.width % 2;  // colours at half resolution
  one.config.height += one.config.height % 2;
  one.config.fixed_corners = true;
  std::vector<StepFacts> frames;
  const int every = file.extension() == ".gif" ? kGifEvery : 1;
  for (int i = 0; i < static_cast<int>(film.size()); i += every) {
    frames.push_back(FrameStep(run, film, i));
  }
  PictureDrawer drawer(run.scene, LabelsOf(run));
  // Not the hand as it comes from far off: what it does would be small.
  std::vector<const StepFacts*> framed = {&frames.back()};
  for (std::size_t i = 0; i < frames.size(); i += 10) {
    if (!std::get<FrameFacts>(frames[i].details).touching.empty()) framed.push_back(&frames[i]);
  }
  one.config.camera = drawer.FrameSteps(framed, run, one.config, view);

  // Beside the file and of its kind, which ffmpeg goes by.
  std::filesystem::path partial = file;
  partial.replace_extension(".partial" + file.extension().string());
  Encoder encoder(EncoderArguments(partial, one.config));
  const auto fail = [&](const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw InputError(file.string(), "", "a film that ffmpeg can write", why);
  };
  bool open = true;
  try {
    for (std::size_t i = 0; open && i < frames.size(); ++i) {
      ThrowIfInterrupted();
      open = encoder.Write(drawer.Render(frames[i], run, one).rgb);
      progress(static_cast<int>(i) + 1, static_cast<int>(frames.size()));
    }
  } catch (const Interrupted&) {
    encoder.Finish();
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw;
  }
  if (!encoder.Finish() || !open) fail("what ffmpeg says above");
  std::error_code error;
  std::filesystem::rename(partial, file, error);
  if (error) fail(error.message());
}

}  // namespace pregrasp
