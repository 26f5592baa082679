#include "tracker_server/programs/objects.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "tracker_server/pose/start_file.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_objects = 32;

Result<ObjectToTrack> read_object(const std::string& given, const fs::path& sequence) {
  fs::path folder = given;
  if (!fs::exists(folder / "model.obj")) folder = sequence / "objects" / given;
  if (!fs::exists(folder / "model.obj"))
    return failure(ErrorCode::not_found, "--object " + given + ": there is no " + given + "/model.obj, nor " +
                                             (folder / "model.obj").string() + ".");
  auto model = read_obj_model(folder / "model.obj");
  if (!model) return tl::make_unexpected(model.error());
  const auto X_CM = read_start_file(folder / "init.json");
  if (!X_CM) return tl::make_unexpected(X_CM.error());
  fs::path name = fs::path(given).lexically_normal();
  if (name.filename().empty()) name = name.parent_path();  // a slash at the end
  return ObjectToTrack{name.filename().string(), std::move(*model), *X_CM};
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream words(list);
  for (std::string name; std::getline(words, name, ',');) names.push_back(name);
  return names;
}

}  // namespace

Result<ObjectGroups> objects_to_track(const ObjectArguments& arguments, const fs::path& sequence,
                                      const std::string& main) {
  if (arguments.objects.size() > most_objects)
    return failure(ErrorCode::invalid_argument,
                   "At most " + std::to_string(most_objects) + " objects can be followed at once.");
  std::vector<ObjectToTrack> objects;
  const auto named = [&](const std::string& name) {
    return std::find_if(objects.begin(), objects.end(), [&](const ObjectToTrack& o) { return o.name == name; });
  };
  for (const std::string& given : arguments.objects) {
    auto object = read_object(given, sequence);
    if (!object) return tl::make_unexpected(object.error());
    if (named(object->name) != objects.end() || object->name == main)
      return failure(ErrorCode::invalid_argument,
                     "--object " + given + ": there is a \"" + object->name + "\" already.");
    objects.push_back(std::move(*object));
  }
  ObjectGroups groups;
  for (const std::string& list : arguments.rigid) {
    std::vector<ObjectToTrack> group;
    bool has_main = false;
    for (const std::string& name : names_in(list)) {
      if (name == main) {
        has_main = true;
        continue;
      }
      const auto object = named(name);
      if (object == objects.end())
        return failure(ErrorCode::invalid_argument, "--rigid " + list + ": \"" + name + "\" is not " + main +
                                                        " and no --object that is in no other rigid group.");
      group.push_back(std::move(*object));
      objects.erase(object);
    }
    if (group.size() + (has_main ? 1 : 0) < 2)
      return failure(ErrorCode::invalid_argument, "--rigid " + list + ": give at least two names with commas between.");
    if (has_main)
      std::move(group.begin(), group.end(), std::back_inserter(groups.with_main));
    else
      groups.others.push_back(std::move(group));
  }
  for (ObjectToTrack& object : objects) {
    groups.others.emplace_back();
    groups.others.back().push_back(std::move(object));
  }
  return groups;
}

}  // namespace counterpart
