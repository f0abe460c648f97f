// parafovea foveate: the kernel log-polar map applied to a picture.
#include "app/commands.h"
#include "renderer/foveate.h"

namespace parafovea {

FoveateCommand::FoveateCommand(CLI::App& program) {
    CLI::App* command = program.add_subcommand("foveate", "Apply the kernel log-polar map to a picture");
    command->footer("Example: parafovea foveate photo.png foveated.png --sigma 1.8 --alpha 4 --gaze 200,300");
    command->add_option("in", in_, "Picture (PNG or JPEG)")->required();
    command->add_option("out", out_, "Picture to write (PNG)")->required();
    foveation_.add_to(*command);
    command->add_flag("--no-filters", no_filters_, "Neither the internal nor the post filter");
    command->callback([this] { run(); });
}

void FoveateCommand::run() const {
    const Image picture = load_image(in_);
    Gpu gpu;
    FoveateOptions options;
    options.internal_filter = !no_filters_;
    save_png(foveate(gpu, picture, foveation_.kernel_setting(), foveation_.gaze_on(picture.size), options),
             out_);
}

}  // namespace parafovea
