// A program that runs, and one that says why it does not.
#include <animeme/programs/command_template.h>
#include <animeme/programs/run_program.h>
#include <animeme/programs/scratch_folder.h>

#include <utility>

int main() {
  namespace tools = animeme::tools;
  const auto command = tools::parse_command("sh -c 'echo {what} >&2; exit 3'");
  const auto folder = tools::ScratchFolder::make();
  if (!command || !folder) return 1;
  const tools::Place what{"what", "nothing"};
  tools::ChildJob job;
  auto arguments = tools::fill_in(*command, {&what, 1});
  if (!arguments) return 1;
  job.arguments = std::move(*arguments);
  job.err = (*folder)->file("err");
  const auto done = tools::run_program(job, {});
  return !done && done.error().message.ends_with("exit code 3; it said: nothing") ? 0 : 1;
}
