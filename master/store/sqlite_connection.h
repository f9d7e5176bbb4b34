// A thin RAII layer over SQLite's C interface: errors as values, nothing else added.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace gauntlet::master {

// A prepared statement. Parameters and columns are numbered from 0. Unsigned values travel as the bits of
// SQLite's signed 64-bit integer. Must not outlive its connection.
class SqliteStatement {
 public:
  SqliteStatement() = default;

  void BindInt(int index, std::int64_t value);
  void BindUint(int index, std::uint64_t value) { BindInt(index, static_cast<std::int64_t>(value)); }
  void BindDouble(int index, double value);  // NaN becomes NULL: SQLite has no NaN
  // The bytes must live until Reset().
  void BindText(int index, std::string_view value);
  void BindBlob(int index, std::string_view value);

  // True when there is a row to read, false at the end. The first failed Bind is reported here.
  Result<bool> Step();
  // Steps a statement that returns no rows, and resets it whatever came of it.
  Status Run();
  // Makes it ready to be bound and stepped again.
  void Reset();

  std::int64_t Int(int column) const;
  std::uint64_t Uint(int column) const { return static_cast<std::uint64_t>(Int(column)); }
  std::string Bytes(int column) const;  // of a text or a blob

 private:
  friend class SqliteConnection;
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };

  void Remember(int code);

  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
  int bind_error_ = 0;
};

// One open database. Not thread-safe: whoever shares it between threads holds a mutex around every use, that
// of its statements included.
class SqliteConnection {
 public:
  enum class Mode {
    kReadOnly,
    kReadWrite,  // the file must exist
    kCreate,     // makes the file when it does not exist
  };

  SqliteConnection() = default;

  // `file` is a path or a `file:` URI. `vfs` names a registered SQLite VFS, "" = the default one. Nothing is
  // read from the file before the first statement.
  static Result<SqliteConnection> Open(const std::string& file, Mode mode, const std::string& vfs = "");

  // Runs statements whose rows, if any, nobody wants.
  Status Execute(const std::string& sql);
  Result<SqliteStatement> Prepare(std::string_view sql);
  // The single integer that a query (a PRAGMA, mostly) answers with; kCorrupt when it answers with none.
  Result<std::int64_t> QueryInt(std::string_view sql);

  // Rows that the last INSERT added: 0 when it met ON CONFLICT DO NOTHING.
  int Changes() const;
  // When off, closing the connection leaves the write-ahead log as it is; SQLite's default is to move it into
  // the database and delete it.
  void CheckpointOnClose(bool on);

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };

  std::unique_ptr<sqlite3, Closer> database_;
};

// A `file:` URI of a path, for query parameters such as "immutable=1".
std::string SqliteUri(std::string_view path, std::string_view parameters);

}  // namespace gauntlet::master
