#include "master/store/sqlite_connection.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "base/system/atomic_file.h"
#include "base/system/resource_limits.h"

namespace gauntlet {
namespace {

ErrorKind KindOf(int code, int system_errno) {
  if (system_errno == ENOSPC || system_errno == EDQUOT) {
    if ((code & 0xff) == SQLITE_IOERR) return ErrorKind::kNoSpace;
  }
  switch (code & 0xff) {
    case SQLITE_FULL:
      return ErrorKind::kNoSpace;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return ErrorKind::kCorrupt;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return ErrorKind::kInUse;
    case SQLITE_NOMEM:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_READONLY:
    case SQLITE_AUTH:
      return ErrorKind::kIo;
    default:
      return ErrorKind::kInternal;
  }
}

Error ErrorOf(sqlite3* database, int code) {
  const int system_errno = sqlite3_system_errno(database);
  std::string message = sqlite3_errmsg(database);
  if ((code & 0xff) == SQLITE_IOERR || (code & 0xff) == SQLITE_CANTOPEN) {
    // SQLite does not always remember the reason.
    message += system_errno != 0 ? fmt::format(" ({})", ErrnoText(system_errno))
                                 : fmt::format(" (limits here: {})", DescribeLimits());
  }
  return {KindOf(code, system_errno), std::move(message)};
}

}  // namespace

void SqliteStatement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void SqliteStatement::Remember(int code) {
  if (bind_error_ == SQLITE_OK) bind_error_ = code;
}

void SqliteStatement::BindInt(int index, std::int64_t value) {
  Remember(sqlite3_bind_int64(statement_.get(), index + 1, value));
}

void SqliteStatement::BindOne(int index, double value) {
  Remember(sqlite3_bind_double(statement_.get(), index + 1, value));
}

void SqliteStatement::BindOne(int index, std::string_view text) {
  // A null pointer would bind NULL.
  const char* bytes = text.data() == nullptr ? "" : text.data();
  Remember(sqlite3_bind_text64(statement_.get(), index + 1, bytes, text.size(), SQLITE_STATIC, SQLITE_UTF8));
}

void SqliteStatement::BindOne(int index, Blob blob) {
  const char* bytes = blob.bytes.data() == nullptr ? "" : blob.bytes.data();
  Remember(sqlite3_bind_blob64(statement_.get(), index + 1, bytes, blob.bytes.size(), SQLITE_STATIC));
}

Result<bool> SqliteStatement::Step() {
  if (bind_error_ != SQLITE_OK) {
    return Error{KindOf(bind_error_, 0), fmt::format("cannot bind: {}", sqlite3_errstr(bind_error_))};
  }
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return ErrorOf(sqlite3_db_handle(statement_.get()), code);
}

void SqliteStatement::Reset() {
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
  bind_error_ = SQLITE_OK;
}

std::int64_t SqliteStatement::Int(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

void SqliteStatement::ReadOne(int column, std::string& bytes) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  bytes.assign(data == nullptr ? "" : static_cast<const char*>(data), size);
}

void SqliteConnection::Closer::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

Result<SqliteConnection> SqliteConnection::Open(const std::string& file, Mode mode, const std::string& vfs) {
  const int access = mode == Mode::kReadOnly    ? SQLITE_OPEN_READONLY
                     : mode == Mode::kReadWrite ? SQLITE_OPEN_READWRITE
                                                : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int flags =
      SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_NOFOLLOW | access;
  SqliteConnection connection;
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &database, flags, vfs.empty() ? nullptr : vfs.c_str());
  connection.database_.reset(database);
  if (code != SQLITE_OK) {
    if (database == nullptr) return Error{ErrorKind::kInternal, sqlite3_errstr(code)};
    return ErrorOf(database, code);
  }
  return connection;
}

Status SqliteConnection::Execute(const std::string& sql) {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return ErrorOf(database_.get(), code);
  return Ok{};
}

Result<SqliteStatement> SqliteConnection::Prepare(std::string_view sql) {
  SqliteStatement statement;
  sqlite3_stmt* prepared = nullptr;
  const int code = sqlite3_prepare_v3(database_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &prepared, nullptr);
  statement.statement_.reset(prepared);
  if (code != SQLITE_OK) return ErrorOf(database_.get(), code);
  return statement;
}

Result<std::int64_t> SqliteConnection::QueryInt(std::string_view sql) {
  TRY(SqliteStatement statement, Prepare(sql));
  TRY(bool row, statement.Step());
  if (!row) return Error{ErrorKind::kCorrupt, fmt::format("no answer to {}", sql)};
  return statement.Int(0);
}

void SqliteConnection::Interrupt() const {
  sqlite3_interrupt(database_.get());
}

int SqliteConnection::Changes() const {
  return sqlite3_changes(database_.get());
}

void SqliteConnection::CheckpointOnClose(bool on) {
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, on ? 0 : 1, nullptr);
}

std::string SqliteUri(const std::string& path, std::string_view parameters) {
  // A connection follows no link at all, and a user's directory may well be reached through some.
  const std::filesystem::path given(path);
  std::error_code error;
  const std::filesystem::path directory = std::filesystem::canonical(
      given.has_parent_path() ? given.parent_path() : std::filesystem::path("."), error);
  const std::string resolved = error ? path : (directory / given.filename()).string();
  // An absolute path may begin with two slashes, which would be read as a host.
  std::string uri = resolved.starts_with('/') ? "file://" : "file:";
  for (const char c : resolved) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '?' || c == '#' || c == '%' || byte <= 0x20 || byte >= 0x7f) {
      uri += fmt::format("%{:02X}", byte);
    } else {
      uri += c;
    }
  }
  return uri + "?" + std::string(parameters);
}

}  // namespace gauntlet
