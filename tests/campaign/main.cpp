// campaign: random adaptations by the program, each checked by code that shares nothing with it.

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "campaign.hpp"

namespace ductile::campaign {
namespace {

const char* const help =
    R"(campaign [OPTION]...: random adaptations, each checked; exit status 1 if any is wrong
  --program FILE    ductile, to be tried
  --minutes N       how long (1)
  --seed S          other seeds, other cases (1)
  --kind NAME       cases of one kind only
  --case N          one case, with all checks; its folder is kept
  --first N         number of the first case (0)
  --cases N         no more than N cases
  --limit SECONDS   a run that takes longer is a fault (20)
  --restless SHARE  of cases that may change at the third call (0.05)
  --workers N       cases side by side (one per core)
  --folder FOLDER   where failing cases are kept
)";

Campaign read_arguments(int count, char** words) {
  Campaign campaign;
  campaign.workers = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  campaign.folder = "campaign";
  campaign.settings.program = "ductile";
  for (int i = 1; i < count; i += 2) {
    const std::string name = words[i];
    if (i + 1 == count) throw std::invalid_argument("expected a value after " + name);
    const std::string value = words[i + 1];
    if (name == "--program")
      campaign.settings.program = value;
    else if (name == "--minutes")
      campaign.minutes = std::stod(value);
    else if (name == "--seed")
      campaign.seed = std::stoull(value);
    else if (name == "--kind")
      campaign.kind = value;
    else if (name == "--first")
      campaign.first = std::stoull(value);
    else if (name == "--cases")
      campaign.count = std::stoull(value);
    else if (name == "--limit")
      campaign.settings.limit_s = std::stod(value);
    else if (name == "--restless")
      campaign.restless_allowed = std::stod(value);
    else if (name == "--workers")
      campaign.workers = std::stoi(value);
    else if (name == "--folder")
      campaign.folder = value;
    else if (name == "--case") {
      campaign.first = std::stoull(value);
      campaign.count = 1;
      campaign.workers = 1;
      campaign.settings.all_checks = true;
    } else {
      throw std::invalid_argument("expected an option, found '" + name + "'");
    }
  }
  if (campaign.settings.program.has_parent_path())
    campaign.settings.program = std::filesystem::absolute(campaign.settings.program);
  campaign.folder = std::filesystem::absolute(campaign.folder);
  return campaign;
}

}  // namespace
}  // namespace ductile::campaign

int main(int count, char** words) {
  using namespace ductile::campaign;
  if (count > 1 && std::string(words[1]) == "--help") {
    std::fputs(help, stdout);
    std::fputs("kinds:", stdout);
    for (const std::string& name : kind_names()) std::printf(" %s", name.c_str());
    std::fputs("\n", stdout);
    return 0;
  }
  try {
    return run_campaign(read_arguments(count, words)) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "campaign: %s\n", error.what());
    return 2;
  }
}
