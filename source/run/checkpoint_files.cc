#include <impm/base/exceptions.h>
#include <impm/base/files.h>
#include <impm/run/checkpoint_files.h>

#include <boost/crc.hpp>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

namespace impm
{
  namespace fs = std::filesystem;

  namespace
  {
    /** Changes with what the files hold. */
    const unsigned int format = 2;

    /** The files of a checkpoint but for its json, in the order of names. */
    std::map<std::string, fs::path>
    files_of(const std::string &folder, const std::string &checkpoint)
    {
      std::map<std::string, fs::path> files;
      for (const auto &file : fs::directory_iterator(folder))
        if (const auto name = file.path().filename().string();
            name.rfind(checkpoint + ".", 0) == 0 &&
            name.rfind(checkpoint + ".json", 0) != 0)
          files[name] = file.path();
      return files;
    }

    unsigned int
    checksum(const fs::path &name)
    {
      std::ifstream      file(name, std::ios::binary);
      boost::crc_32_type crc;
      std::vector<char>  buffer(1 << 20);
      while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0)
        crc.process_bytes(buffer.data(), file.gcount());
      if (!file.eof())
        throw SystemError("cannot read '" + name.string() + "'");
      return crc.checksum();
    }

    /** Throws SystemError if the disk does not take so many bytes: p4est would
     * abort the program then, without a word of the file. */
    void
    require_room(const std::string &name, const unsigned long bytes)
    {
      const int  file  = open(name.c_str(), O_CREAT | O_WRONLY, 0666);
      const bool there = file >= 0 && posix_fallocate(file, 0, bytes) == 0;
      if (file >= 0)
        close(file);
      std::error_code ignored;
      fs::remove(name, ignored);
      if (!there)
        throw SystemError("cannot write '" + name + "' (disk full?)");
    }

    /** Why a checkpoint is not whole; empty if it is. */
    std::string
    find_flaw(const std::string &folder, const std::string &name)
    {
      const std::string file = folder + "/" + name + ".json";
      try
        {
          const auto about = nlohmann::json::parse(content_of(file));
          if (about.at("format") != format)
            return file + " is of another version of the program";
          for (const auto &[part, sum] : about.at("checksums").items())
            if (const auto path = folder + "/" + part;
                !fs::exists(path) || checksum(path) != sum)
              return path + " is missing or damaged";
        }
      catch (const nlohmann::json::exception &)
        {
          return file + " is missing or damaged";
        }
      return "";
    }
  } // namespace

  bool
  has_checkpoint(const std::string &run_directory)
  {
    // A crash may have come between the first one and the file that names it.
    const std::string folder = run_directory + "/checkpoint/";
    return fs::exists(folder + "last_good") || fs::exists(folder + "a.json") ||
           fs::exists(folder + "b.json");
  }

  CheckpointFiles::CheckpointFiles(const std::string &run_directory)
    : folder(run_directory + "/checkpoint")
  {}

  std::string
  CheckpointFiles::begin(const unsigned long bytes)
  {
    const std::string name = last == "a" ? "b" : "a";
    std::error_code   error;
    // No directory of the run: whoever has taken it away does not want it.
    fs::create_directory(folder, error);
    if (error)
      throw SystemError("cannot make the directory '" + folder +
                        "': " + error.message());
    fs::remove(folder + "/" + name + ".json", error);
    for (const auto &[file, path] : files_of(folder, name))
      fs::remove(path, error);
    require_room(folder + "/" + name + ".grid", bytes);
    return folder + "/" + name;
  }

  void
  CheckpointFiles::finish(nlohmann::ordered_json about)
  {
    const std::string name = last == "a" ? "b" : "a";
    about["format"]        = format;
    for (const auto &[file, path] : files_of(folder, name))
      about["checksums"][file] = checksum(path);
    replace_file(folder + "/" + name + ".json", about.dump(2) + "\n");
    replace_file(folder + "/last_good", name + "\n");
    last = name;
  }

  CheckpointFiles::Found
  CheckpointFiles::find()
  {
    std::string marked;
    std::ifstream(folder + "/last_good") >> marked;
    Found found;
    for (const std::string name :
         {marked == "b" ? "b" : "a", marked == "b" ? "a" : "b"})
      {
        const auto flaw = find_flaw(folder, name);
        if (flaw.empty())
          {
            last       = name;
            found.path = folder + "/" + name;
            break;
          }
        if (found.flaw.empty())
          found.flaw = flaw;
      }
    return found;
  }
} // namespace impm
