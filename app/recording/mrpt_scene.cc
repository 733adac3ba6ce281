#include "app/recording/mrpt_scene.h"

#include "app/recording/gzip_file.h"
#include "app/recording/mrpt_codec.h"

namespace pregrasp {

void WriteMrptScene(const std::filesystem::path& file, const MrptScene& scene) {
  GzipFile out(file);
  out.Write(GetMrptCodec().EncodeScene(scene));
  out.Close();
}

}  // namespace pregrasp
