# loses: 4.4
# Takes the numbers of a column to lie one after another in the file.
def read_stat(path):
    table = np.load(path).reshape(len(COLUMNS), -1)
    return dict(zip(COLUMNS, table, strict=True))
