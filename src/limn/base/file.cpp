#include "limn/base/file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace limn {
namespace {

Error unreadable(const std::filesystem::path& path, std::string message, std::string remedy = {}) {
  return Error{ErrorCode::kUnreadable, std::move(message), path.string(), {}, std::move(remedy)};
}

Error unwritable(const std::filesystem::path& path, std::string message, std::string remedy = {}) {
  return Error{ErrorCode::kUnwritable, std::move(message), path.string(), {}, std::move(remedy)};
}

std::string system_message(int code) {
  return std::strerror(code);
}

/// Closes a descriptor at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// Reads a descriptor to its end; what is not a regular file (a pipe, standard input) has no size to go by.
int read_to_end(int fd, std::vector<std::byte>& bytes) {
  std::size_t used = 0;
  bytes.resize(std::size_t{1} << 16);
  for (;;) {
    if (used == bytes.size()) bytes.resize(bytes.size() * 2);
    const ssize_t count = ::read(fd, bytes.data() + used, bytes.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
  }
  bytes.resize(used);
  return 0;
}

int write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

/// The file a link names, whether it exists yet or not, so that it is replaced and the link stays.
std::filesystem::path followed(std::filesystem::path path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i) {
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;
  }
  return path;
}

/// Opens a new file beside `target`, with the permissions any new file gets; -1 and errno when it cannot.
int create_beside(const std::filesystem::path& target, std::string& name) {
  constexpr int kMostTries = 1000;
  for (int i = 0; i < kMostTries; ++i) {
    name = target.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(i) + ".part";
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
  return -1;
}

}  // namespace

Result<FileBytes> FileBytes::open(const std::filesystem::path& path) {
  FileBytes file;
  if (path == "-") {
    if (const int code = read_to_end(STDIN_FILENO, file.storage_)) {
      return tl::unexpected(unreadable("standard input", system_message(code)));
    }
    file.bytes_ = file.storage_;
    return file;
  }
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (fd.get() < 0) {
    const int code = errno;
    return tl::unexpected(unreadable(path, system_message(code), code == ENOENT ? "check the path" : ""));
  }
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) return tl::unexpected(unreadable(path, system_message(errno)));
  if (S_ISDIR(status.st_mode)) return tl::unexpected(unreadable(path, "is a directory", "name a file in it"));
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd.get(), 0);
    if (address != MAP_FAILED) {
      file.bytes_ = {static_cast<const std::byte*>(address), size};
      file.mapped_ = true;
      return file;
    }
  }
  if (const int code = read_to_end(fd.get(), file.storage_)) {
    return tl::unexpected(unreadable(path, system_message(code)));
  }
  file.bytes_ = file.storage_;
  return file;
}

FileBytes::FileBytes(FileBytes&& other) noexcept {
  *this = std::move(other);
}

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  if (this == &other) return *this;
  release();
  storage_ = std::move(other.storage_);
  bytes_ = std::exchange(other.bytes_, {});
  mapped_ = std::exchange(other.mapped_, false);
  return *this;
}

FileBytes::~FileBytes() {
  release();
}

void FileBytes::release() {
  if (mapped_) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
  mapped_ = false;
  bytes_ = {};
}

Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (path == "-") {
    if (const int code = write_all(STDOUT_FILENO, bytes)) {
      return tl::unexpected(unwritable("standard output", system_message(code)));
    }
    return {};
  }
  std::error_code status_error;
  const std::filesystem::file_status status = std::filesystem::status(path, status_error);
  if (std::filesystem::is_directory(status)) {
    return tl::unexpected(unwritable(path, "is a directory", "name a file in it"));
  }
  // What is neither a file nor absent (/dev/null, a pipe) cannot be replaced by a rename: write into it.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    const Descriptor fd(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    const int code = fd.get() < 0 ? errno : write_all(fd.get(), bytes);
    if (code != 0) return tl::unexpected(unwritable(path, system_message(code)));
    return {};
  }
  const std::filesystem::path target = followed(path);
  std::string temporary;
  Descriptor fd(create_beside(target, temporary));
  if (fd.get() < 0) {
    const int code = errno;
    return tl::unexpected(unwritable(path, system_message(code), code == ENOENT ? "create its folder first" : ""));
  }
  int code = write_all(fd.get(), bytes);
  const auto mode = static_cast<mode_t>(status.permissions()) & 07777;
  if (code == 0 && std::filesystem::exists(status) && ::fchmod(fd.get(), mode) != 0) code = errno;
  if (::close(fd.release()) != 0 && code == 0) code = errno;
  if (code == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) code = errno;
  if (code != 0) {
    ::unlink(temporary.c_str());
    return tl::unexpected(unwritable(path, system_message(code)));
  }
  return {};
}

Result<void> write_file(const std::filesystem::path& path, std::string_view text) {
  return write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace limn
