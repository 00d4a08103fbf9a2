// A program that runs, and one that says why it does not.
#include <animeme/programs/command_template.h>
#include <animeme/programs/run_program.h>
#include <animeme/programs/scratch_folder.h>

int main() {
  namespace tools = animeme::tools;
  const auto command = tools::parse_command("sh -c 'echo {what} >&2; exit 3'");
  const auto folder = tools::ScratchFolder::make();
  if (!command || !folder) return 1;
  const tools::Place what{"what", "nothing"};
  tools::ChildJob job;
  job.arguments = tools::fill_in(*command, {&what, 1});
  job.err = (*folder)->file("err");
  const auto done = tools::run_program(job, {});
  return !done && done.error().message.ends_with("exit code 3; it said: nothing") ? 0 : 1;
}
